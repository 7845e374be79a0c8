#include "gui/models/checks_panel.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QRegularExpression>
#include <QToolButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "gui/window/theme.h"
#include "job/job.h"

namespace searchlight::gui {

ChecksPanel::ChecksPanel(Desk& desk, QWidget* parent) : QWidget(parent), desk_(desk) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->setSpacing(Space::xs);
    auto* row = new QHBoxLayout;
    auto* run = new QToolButton(this);
    run->setObjectName(QStringLiteral("models.check"));
    run->setText(tr("Check"));
    run->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    run->setToolTip(tr("Compile, evaluate and integrate the model: does it keep what it promises?"));
    run->setAccessibleDescription(run->toolTip());
    const auto draw = [run, &theme = desk.theme] { run->setIcon(theme.icon(QStringLiteral("check"))); };
    draw();
    connect(&desk.theme, &Theme::changed, run, draw);
    connect(run, &QToolButton::clicked, this, [this] { check(); });
    summary_ = new QLabel(tr("Not checked yet"), this);
    summary_->setObjectName(QStringLiteral("models.summary"));
    row->addWidget(run);
    row->addWidget(summary_, 1);
    layout->addLayout(row);
    checks_ = new QTreeWidget(this);
    checks_->setObjectName(QStringLiteral("models.checks"));
    checks_->setAccessibleName(tr("Results of the checks"));
    checks_->setColumnCount(2);
    checks_->setHeaderHidden(true);
    checks_->setRootIsDecorated(false);
    checks_->setFrameShape(QFrame::NoFrame);
    checks_->setSelectionMode(QAbstractItemView::NoSelection);
    checks_->setWordWrap(true);
    checks_->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
    layout->addWidget(checks_, 1);
}

void ChecksPanel::check() {
    Job job;
    job.command = "check";
    const std::string id = desk_.workspace.state().activeModel().model.id;
    job.options["model"] = id;
    summary_->setText(tr("Checking…"));
    checks_->clear();
    desk_.tasks.start(
        {.lane = "checks", .key = "check", .title = tr("Checking the model"), .receiver = this},
        [this, job](TaskContext& context) {
            const JobResult result = run(job, context.engine(), context);
            context.publish(
                [this, text = QString::fromStdString(result.text), passed = result.passed] { show(text, passed); });
        },
        [this](const Error& error) {
            summary_->setText(tr("It does not run"));
            auto* item = new QTreeWidgetItem(checks_);
            item->setIcon(0, desk_.theme.icon(QStringLiteral("warning")));
            item->setText(1, QString::fromUtf8(error.what()));
        });
}

// "  pass  finite   ..." as a row; the line with the counts is the summary.
void ChecksPanel::show(const QString& text, bool passed) {
    const QRegularExpression row(QStringLiteral("^\\s+(pass|FAIL|note|skip)\\s+(\\S+)\\s*(.*)$"));
    int failed = 0, all = 0;
    for (const QString& line : text.split(QLatin1Char('\n'))) {
        const QRegularExpressionMatch match = row.match(line);
        if (!match.hasMatch()) continue;
        auto* item = new QTreeWidgetItem(checks_);
        const bool fail = match.captured(1) == QLatin1String("FAIL");
        failed += fail ? 1 : 0;
        ++all;
        item->setIcon(0, desk_.theme.icon(QLatin1String(fail ? "warning" : "check")));
        item->setText(0, match.captured(2));
        item->setText(1, match.captured(3));
        item->setToolTip(1, match.captured(3));
        item->setData(0, Qt::AccessibleTextRole, match.captured(1) + QLatin1Char(' ') + match.captured(2));
        if (fail) item->setForeground(0, desk_.theme.colors().error);
    }
    summary_->setText(passed ? tr("%1 checks, none failed").arg(all) : tr("%1 of %2 failed").arg(failed).arg(all));
}

}  // namespace searchlight::gui

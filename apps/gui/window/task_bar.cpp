#include "gui/window/task_bar.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QToolButton>
#include <cmath>

#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

// Shorter work is over before a bar is read.
constexpr double moment_s = 0.4;

QString durationText(double seconds) {
    if (seconds < 60) return QObject::tr("%1 s").arg(std::ceil(seconds));
    if (seconds < 3600)
        return QObject::tr("%1 min %2 s").arg(std::floor(seconds / 60)).arg(std::floor(std::fmod(seconds, 60)));
    return QObject::tr("%1 h").arg(seconds / 3600, 0, 'f', 1);
}

}  // namespace

TaskBar::TaskBar(Desk& desk, QWidget* parent) : QWidget(parent), desk_(desk) {
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(Space::s, 0, Space::s, 0);
    row->setSpacing(Space::s);
    text_ = new QLabel(this);
    text_->setProperty("role", "muted");
    bar_ = new QProgressBar(this);
    bar_->setObjectName("task.bar");
    bar_->setRange(0, 1000);
    bar_->setTextVisible(false);
    bar_->setFixedWidth(160);
    bar_->setAccessibleName(tr("Progress"));
    cancel_ = new QToolButton(this);
    cancel_->setObjectName("task.cancel");
    cancel_->setIcon(desk.theme.icon("close"));
    cancel_->setIconSize({12, 12});
    // No higher than a line of text: it stands at the edge of the window all the time.
    cancel_->setFixedSize(26, 22);
    cancel_->setToolTip(tr("Cancel"));
    cancel_->setAccessibleName(tr("Cancel the running task"));
    for (QWidget* each : {static_cast<QWidget*>(text_), static_cast<QWidget*>(bar_), static_cast<QWidget*>(cancel_)}) {
        row->addWidget(each);
        // The bar is as high without a task, or the view above would change its size and its picture begin anew.
        QSizePolicy policy = each->sizePolicy();
        policy.setRetainSizeWhenHidden(true);
        each->setSizePolicy(policy);
    }
    connect(cancel_, &QToolButton::clicked, this, [this] { desk_.tasks.cancel(shown_); });
    connect(&desk_.tasks, &Tasks::statusChanged, this, &TaskBar::refresh);
    connect(&desk_.theme, &Theme::changed, this, [this] { cancel_->setIcon(desk_.theme.icon("close")); });
    tick_.setInterval(250);
    connect(&tick_, &QTimer::timeout, this, &TaskBar::refresh);
    refresh();
}

void TaskBar::refresh() {
    const std::vector<TaskStatus> all = desk_.tasks.status();
    const TaskStatus* longest = nullptr;
    for (const TaskStatus& task : all)
        if (task.seconds >= moment_s && (!longest || task.seconds > longest->seconds)) longest = &task;
    // A task that reports nothing still has to appear after its moment, and to leave.
    if (all.empty())
        tick_.stop();
    else if (!tick_.isActive())
        tick_.start();
    for (QWidget* each : {static_cast<QWidget*>(text_), static_cast<QWidget*>(bar_), static_cast<QWidget*>(cancel_)})
        each->setVisible(longest != nullptr);
    if (!longest) return;
    shown_ = longest->id;
    QString text = longest->title;
    if (longest->seconds_left >= 1) text += tr(", %1 left").arg(durationText(longest->seconds_left));
    if (all.size() > 1) text += tr(" (and %1 more)").arg(all.size() - 1);
    text_->setText(text);
    bar_->setRange(0, longest->fraction < 0 ? 0 : 1000);
    if (longest->fraction >= 0) bar_->setValue(static_cast<int>(1000 * longest->fraction));
}

}  // namespace searchlight::gui

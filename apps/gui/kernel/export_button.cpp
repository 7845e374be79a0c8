#include "gui/kernel/export_button.h"

#include <QApplication>
#include <QClipboard>
#include <QFileDialog>
#include <QMenu>

#include "base/files.h"
#include "gui/kernel/kernel_options.h"
#include "gui/window/theme.h"
#include "job/kernel/kernel_export.h"

namespace searchlight::gui {

namespace {

QString formatTitle(const std::string& name) {
    if (name == "json" || name == "c" || name == "hlsl" || name == "glsl")
        return QString::fromStdString(name).toUpper();
    return name == "unity"    ? QStringLiteral("Unity HDRP profile")
           : name == "unreal" ? QStringLiteral("Unreal profile")
                              : QStringLiteral("Godot");
}

QString fileEnding(const std::string& name) {
    if (name == "unreal" || name == "unity") return QStringLiteral("txt");
    if (name == "godot") return QStringLiteral("gdshaderinc");
    return name == "c" ? QStringLiteral("h") : QString::fromStdString(name);
}

}  // namespace

KernelExportButton::KernelExportButton(Desk& desk, QWidget* parent) : QToolButton(parent), desk_(desk) {
    setObjectName(QStringLiteral("kernel.export"));
    setText(tr("Export"));
    setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    const auto paint = [this] { setIcon(desk_.theme.icon("export")); };
    paint();
    connect(&desk_.theme, &Theme::changed, this, paint);
    setAccessibleName(tr("Export the kernel"));
    setPopupMode(InstantPopup);
    auto* menu = new QMenu(this);
    for (const std::string& format : kernelExports())
        menu->addAction(tr("Save %1…").arg(formatTitle(format)), this, [this, format] { save(format); });
    menu->addSeparator();
    for (const std::string& format : kernelExports()) {
        QAction* copy = menu->addAction(tr("Copy %1").arg(formatTitle(format)), this, [this, format] {
            make(format,
                 [](const std::string& text) { QApplication::clipboard()->setText(QString::fromStdString(text)); });
        });
        copy->setObjectName(QStringLiteral("kernel.copy.") + QString::fromStdString(format));
    }
    menu->addSeparator();
    QAction* command = menu->addAction(tr("Copy as command line"), this, [this] {
        QApplication::clipboard()->setText(kernelCommandLine(desk_.workspace.state()));
    });
    connect(menu, &QMenu::aboutToShow, this,
            [this, command] { command->setEnabled(!kernelCommandLine(desk_.workspace.state()).isEmpty()); });
    setMenu(menu);
    setKernel(nullptr);
}

void KernelExportButton::setKernel(std::shared_ptr<const KernelShown> shown) {
    shown_ = std::move(shown);
    setEnabled(shown_ != nullptr);
}

// An engine's profile is a fit: not on the window's thread, and not behind the errors that the table waits for.
void KernelExportButton::make(const std::string& format, std::function<void(const std::string&)> take) {
    if (!shown_) return;
    desk_.tasks.start(
        {.lane = "kernel export", .key = "export", .title = tr("Export"), .receiver = this},
        [shown = shown_, format, take = std::move(take)](TaskContext& context) {
            const std::string text = exportedKernel(format, *shown->judged, shown->base->subject, shown->base->truth);
            context.publish([take, text] { take(text); });
        },
        [this](const Error& error) { desk_.notices.post(error); });
}

void KernelExportButton::save(const std::string& format) {
    if (!shown_) return;
    const QString name = QString::fromStdString(shown_->base->subject.id) + QStringLiteral("_kernel.");
    const QString path = QFileDialog::getSaveFileName(this, tr("Save kernel"), name + fileEnding(format));
    if (path.isEmpty()) return;
    make(format, [this, path](const std::string& text) {
        try {
            writeFile(path.toStdString(), text);
            desk_.notices.post(Notices::Level::info, tr("Saved %1").arg(path));
        } catch (const Error& error) {
            desk_.notices.post(error);
        }
    });
}

}  // namespace searchlight::gui

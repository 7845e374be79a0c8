// The button that writes a kernel to a file, or copies it, in each format of job/kernel_export.h.
#pragma once

#include <QToolButton>
#include <functional>
#include <memory>
#include <string>

#include "gui/kernel/live_kernels.h"
#include "gui/window/desk.h"

namespace searchlight::gui {

class KernelExportButton : public QToolButton {
    Q_OBJECT

public:
    KernelExportButton(Desk& desk, QWidget* parent);

    /// What is exported; null: nothing.
    void setKernel(std::shared_ptr<const KernelShown> shown);

private:
    void make(const std::string& format, std::function<void(const std::string&)> take);
    void save(const std::string& format);

    Desk& desk_;
    std::shared_ptr<const KernelShown> shown_;
};

}  // namespace searchlight::gui

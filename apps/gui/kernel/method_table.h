// All kernels of a material with their errors; the row that is chosen is the kernel that is looked at.
#pragma once

#include <QTableWidget>

#include "gui/kernel/kernel_options.h"
#include "job/kernel/kernel_judged.h"

namespace searchlight::gui {

class Theme;

class MethodTable : public QTableWidget {
    Q_OBJECT

public:
    explicit MethodTable(Theme& theme, QWidget* parent = nullptr);

    /// Errors of one row. A click on a column's title sorts by it.
    void setRow(const std::string& name, const JudgedKernel& judged, bool perceptual);
    /// Every row is without errors again.
    void clearRows();
    /// Shows a choice; emits nothing.
    void setChosen(const std::string& name);

    /// What stands in a row's column; empty: not known yet.
    QString cell(const std::string& name, int column) const;

    QSize sizeHint() const override { return {360, 240}; }

Q_SIGNALS:
    void chosen(const QString& name);

private:
    int rowOf(const std::string& name) const;
    void markBest();

    Theme& theme_;
};

}  // namespace searchlight::gui

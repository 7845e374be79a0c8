// What takes longer than a moment: its progress, the time left, and a way to cancel it. In the status bar.
#pragma once

#include <QTimer>
#include <QWidget>

#include "gui/window/desk.h"

class QLabel;
class QProgressBar;
class QToolButton;

namespace searchlight::gui {

class TaskBar : public QWidget {
    Q_OBJECT

public:
    explicit TaskBar(Desk& desk, QWidget* parent = nullptr);

private:
    void refresh();

    Desk& desk_;
    QLabel* text_;
    QProgressBar* bar_;
    QToolButton* cancel_;
    QTimer tick_;
    std::uint64_t shown_ = 0;  ///< id of the task
};

}  // namespace searchlight::gui

// What `searchlight check` finds of the active model.
#pragma once

#include <QWidget>

#include "gui/window/desk.h"

class QLabel;
class QTreeWidget;

namespace searchlight::gui {

class ChecksPanel : public QWidget {
    Q_OBJECT

public:
    explicit ChecksPanel(Desk& desk, QWidget* parent = nullptr);

private:
    void check();
    void show(const QString& text, bool passed);

    Desk& desk_;
    QTreeWidget* checks_;
    QLabel* summary_;
};

}  // namespace searchlight::gui

// Three ways to begin, over the object view at the first start.
#pragma once

#include <QFrame>

#include "gui/window/desk.h"

class QBoxLayout;

namespace searchlight::gui {

class Welcome : public QFrame {
    Q_OBJECT

public:
    Welcome(Desk& desk, QWidget* host);

Q_SIGNALS:
    /// "material", "editor" or "compare".
    void chosen(const QString& way);
    void closed();

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

private:
    void place();
    QWidget* host_;
    QBoxLayout* ways_;
};

}  // namespace searchlight::gui

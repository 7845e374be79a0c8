// Notices float over the object view for a while; errors stay until they are closed.
#pragma once

#include <QFrame>
#include <QTimer>

#include "gui/window/desk.h"

class QLabel;

namespace searchlight::gui {

class NoticeBar : public QFrame {
    Q_OBJECT

public:
    /// Places itself along the lower edge of `host`.
    NoticeBar(Desk& desk, QWidget* host);

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void show(Notices::Level level, const QString& text);
    void place();

    QWidget* host_;
    QLabel* text_;
    QTimer hide_;
};

}  // namespace searchlight::gui

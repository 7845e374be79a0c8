// Whether a person sees what a dock holds: behind another tab it counts as visible for its widgets.
#pragma once

#include <QWidget>

namespace searchlight::gui {

class Seen : public QObject {
    Q_OBJECT

public:
    /// Of the widget that a dock holds, or that stands alone. A member of it, and no child: a widget that ends hides,
    /// and whoever listens in it is gone by then.
    explicit Seen(QWidget* body);

    bool now() const { return now_; }

Q_SIGNALS:
    void changed(bool seen);

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void set(bool seen);

    QWidget* body_;
    bool now_ = false;
};

}  // namespace searchlight::gui

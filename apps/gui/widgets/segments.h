// A few choices side by side, one of them chosen.
#pragma once

#include <QStringList>
#include <QWidget>
#include <vector>

class QToolButton;

namespace searchlight::gui {

class Segments : public QWidget {
    Q_OBJECT

public:
    Segments(const QString& name, const QStringList& texts, QWidget* parent = nullptr);

    int current() const { return current_; }
    /// Shows a choice; emits nothing.
    void setCurrent(int index);
    void setToolTips(const QStringList& tips);

Q_SIGNALS:
    void chosen(int index);

private:
    std::vector<QToolButton*> buttons_;
    int current_ = 0;
};

}  // namespace searchlight::gui

// Controls from the left, in as many rows as the width asks for.
#pragma once

#include <QLayout>
#include <QList>

namespace searchlight::gui {

/// All of one height. Spare width goes to the items of a row whose size policy expands.
class FlowRow : public QLayout {
public:
    explicit FlowRow(QWidget* parent = nullptr) : QLayout(parent) {}
    ~FlowRow() override;

    void addItem(QLayoutItem* item) override { items_ << item; }
    int count() const override { return static_cast<int>(items_.size()); }
    QLayoutItem* itemAt(int index) const override { return items_.value(index); }
    QLayoutItem* takeAt(int index) override;
    QSize sizeHint() const override;
    QSize minimumSize() const override;
    bool hasHeightForWidth() const override { return true; }
    int heightForWidth(int width) const override { return place({0, 0, width, 0}, false); }
    void setGeometry(const QRect& rect) override;

private:
    int place(const QRect& rect, bool move) const;

    QList<QLayoutItem*> items_;
};

}  // namespace searchlight::gui

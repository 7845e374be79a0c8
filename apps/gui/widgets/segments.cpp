#include "gui/widgets/segments.h"

#include <QHBoxLayout>
#include <QToolButton>

namespace searchlight::gui {

Segments::Segments(const QString& name, const QStringList& texts, QWidget* parent) : QWidget(parent) {
    setAccessibleName(name);
    auto* row = new QHBoxLayout(this);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(0);
    for (int i = 0; i < texts.size(); ++i) {
        auto* button = new QToolButton(this);
        button->setObjectName("segment");
        button->setProperty("first", i == 0);
        button->setProperty("last", i == texts.size() - 1);
        button->setText(texts[i]);
        button->setAccessibleName(name + ": " + texts[i]);
        button->setCheckable(true);
        button->setChecked(i == 0);
        button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
        button->setFocusPolicy(Qt::StrongFocus);
        connect(button, &QToolButton::clicked, this, [this, i] {
            const bool other = current_ != i;
            setCurrent(i);
            if (other) emit chosen(i);
        });
        row->addWidget(button);
        buttons_.push_back(button);
    }
}

void Segments::setCurrent(int index) {
    current_ = index;
    for (int i = 0; i < static_cast<int>(buttons_.size()); ++i)
        buttons_[static_cast<std::size_t>(i)]->setChecked(i == index);
}

void Segments::setToolTips(const QStringList& tips) {
    for (int i = 0; i < std::min<int>(static_cast<int>(buttons_.size()), static_cast<int>(tips.size())); ++i)
        buttons_[static_cast<std::size_t>(i)]->setToolTip(tips[i]);
}

}  // namespace searchlight::gui

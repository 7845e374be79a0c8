#include "gui/material/preset_list.h"

#include <QLineEdit>
#include <QListWidget>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "gui/material/material_edit.h"
#include "gui/window/theme.h"
#include "scene/materials.h"

namespace searchlight::gui {

PresetList::PresetList(Desk& desk, QWidget* parent) : QWidget(parent) {
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(Space::xs);
    search_ = new QLineEdit(this);
    search_->setPlaceholderText(tr("Search %1 measured materials").arg(materials().size()));
    search_->setClearButtonEnabled(true);
    search_->setAccessibleName(tr("Search materials"));
    search_->addAction(desk.theme.icon("search"), QLineEdit::LeadingPosition)->setToolTip(tr("Search"));
    column->addWidget(search_);
    list_ = new QListWidget(this);
    list_->setObjectName("presets");
    list_->setAccessibleName(tr("Materials"));
    list_->setUniformItemSizes(true);
    list_->setMinimumHeight(120);
    list_->setMaximumHeight(168);
    column->addWidget(list_);
    for (const Material& material : materials()) {
        auto* item = new QListWidgetItem(swatchIcon(appearanceColor(material.medium)),
                                         QString::fromStdString(material.name), list_);
        item->setData(Qt::UserRole, QString::fromStdString(material.id));
        QString tip = QString::fromStdString(material.citation);
        if (!material.note.empty()) tip += "\n" + QString::fromStdString(material.note);
        if (!material.unit_known) tip += "\n" + tr("The table does not state its unit: it is taken as 1/mm.");
        item->setToolTip(tip);
    }
    connect(search_, &QLineEdit::textChanged, this, &PresetList::search);
    connect(search_, &QLineEdit::returnPressed, this, [this] {
        for (int i = 0; i < list_->count(); ++i)
            if (!list_->item(i)->isHidden()) {
                emit chosen(list_->item(i)->data(Qt::UserRole).toString());
                return;
            }
    });
    connect(list_, &QListWidget::currentItemChanged, this, [this](QListWidgetItem* item) {
        if (item) emit chosen(item->data(Qt::UserRole).toString());
    });
}

void PresetList::setCurrent(const std::string& id) {
    const QSignalBlocker quiet(list_);
    list_->setCurrentItem(nullptr);
    if (id.empty()) return;
    const std::string own = [&] {
        try {
            return findMaterial(id).id;
        } catch (const std::exception&) {
            return std::string();
        }
    }();
    for (int i = 0; i < list_->count(); ++i)
        if (list_->item(i)->data(Qt::UserRole).toString().toStdString() == own) {
            list_->setCurrentRow(i);
            list_->scrollToItem(list_->item(i));
        }
}

void PresetList::search(const QString& text) {
    for (int i = 0; i < list_->count(); ++i) {
        QListWidgetItem* item = list_->item(i);
        const QString words = item->text() + " " + item->data(Qt::UserRole).toString() + " " + item->toolTip();
        bool found = true;
        for (const QString& word : text.split(' ', Qt::SkipEmptyParts))
            found = found && words.contains(word, Qt::CaseInsensitive);
        item->setHidden(!found);
    }
}

}  // namespace searchlight::gui

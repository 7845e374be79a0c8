// Measured materials, searched as one types, each with the colour of a thick piece of it.
#pragma once

#include <QWidget>

#include "gui/window/desk.h"

class QLineEdit;
class QListWidget;

namespace searchlight::gui {

class PresetList : public QWidget {
    Q_OBJECT

public:
    explicit PresetList(Desk& desk, QWidget* parent = nullptr);

    /// Marks the preset of that id; an id that is none marks nothing.
    void setCurrent(const std::string& id);

Q_SIGNALS:
    void chosen(const QString& id);

private:
    void search(const QString& text);

    QLineEdit* search_;
    QListWidget* list_;
};

}  // namespace searchlight::gui

// The table of docks: one row each, made in the dock's own folder.
#pragma once

#include <QKeySequence>
#include <QString>
#include <span>

#include "gui/window/desk.h"

class QWidget;

namespace searchlight::gui {

/// A row of the table. The order is that of the View menu, and of tabs within an area.
struct DockEntry {
    const char* id;     ///< object name; the saved layout knows the dock by it
    const char* title;  ///< of its tab
    const char* doc;    ///< one line: tool tip, and what a screen reader says
    Qt::DockWidgetArea area;
    const char* shortcut;  ///< shows or hides it
    const char* icon;      ///< a name for Theme::icon()
    bool shown;            ///< at the first start
    QWidget* (*make)(Desk& desk);
};

/// In menu order.
std::span<const DockEntry> docks();

}  // namespace searchlight::gui

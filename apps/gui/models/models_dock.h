// The models that are compared: which, in what colour, whether they work, and what the checks say.
#pragma once

#include "gui/window/desk.h"

class QWidget;

namespace searchlight::gui {

QWidget* makeModelsDock(Desk& desk);

/// Adds a slot for the model and makes it the active one: a step of undo.
void addModel(Workspace& workspace, const QString& id);

/// A file of its own for a new model from that template (model_files.h), added. Returns its path; throws Error.
QString addNewModel(Workspace& workspace, const QString& template_id);

/// Shows and raises the dock of that id in the window of `widget`.
void raiseDock(QWidget* widget, const QString& id);

}  // namespace searchlight::gui

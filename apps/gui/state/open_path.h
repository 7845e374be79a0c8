// Files that a user opens or drops: what a path is, its ending says.
#pragma once

#include <QString>

#include "gui/state/workspace.h"

namespace searchlight::gui {

enum class FileKind { workspace, shape, picture, model, unknown };

FileKind kindOf(const QString& path);

/// Opens a workspace or scene; or, as a step of undo, puts a shape in the place of the object, a picture in the place
/// of the light, or adds a model and makes it the active one. Throws an input Error; a file that is neither is one, and
/// its hint lists what is. Shapes and pictures are read later, by the engine.
void openPath(Workspace& workspace, const QString& path);

/// Of a file dialog: everything that openPath() takes.
QString openFilter();

}  // namespace searchlight::gui

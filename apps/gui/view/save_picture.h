// The picture of the object view, as a file.
#pragma once

#include "gui/view/picture_service.h"

namespace searchlight::gui {

/// Linear values into .exr, .hdr and .pfm, what is seen into .png, with the job inside; beside the window. Faults and
/// success are notices.
void writePicture(Desk& desk, const ViewPicture& shown, const QString& path, QObject* receiver);

}  // namespace searchlight::gui

// What an edit does to a material: presets become numbers, colours of numbers.
#pragma once

#include <QColor>
#include <QIcon>
#include <string>

#include "scene/medium.h"
#include "scene/scene.h"

namespace searchlight::gui {

/// The same medium with its coefficients spelled out, three of each, so that one of them can be changed. A material by
/// (Rdr, ld) stays one. Throws as findMaterial.
SceneMaterial spelledOut(const SceneMaterial& material);

/// A colour for coefficients of any size: linear RGB scaled to a luminance of 0.75 (section 3.6.1 of the BSSRDF
/// Explorer's thesis), shown in sRGB.
QColor swatchColor(Rgb value);

/// About what a thick piece of it looks like: its total diffuse reflectance by the better dipole.
QColor appearanceColor(const Medium& medium);

/// A disc of that colour.
QIcon swatchIcon(QColor color);

/// Why the numbers describe no medium, in words; empty: they do.
QString whyImpossible(const SceneMaterial& material);

}  // namespace searchlight::gui

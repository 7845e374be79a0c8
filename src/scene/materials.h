// Measured materials: one CSV table per publication, docs/scene.md says how to add a row.
#pragma once

#include <string_view>
#include <vector>

#include "scene/medium.h"

namespace searchlight {

/// The materials of the embedded data/materials/*.csv in menu order; tables without a unit come last.
const std::vector<Material>& materials();

/// The material of that id or alias, of "source:id", or of "path.csv:id" in a table of the same format (without id when
/// it has one row). Throws a usage Error for an unknown or ambiguous id, an input Error for a table with a fault.
Material findMaterial(std::string_view id);

/// The rows of one table, ids as written; `path` gives messages and the table's id. Throws an input Error.
std::vector<Material> parseMaterials(std::string_view text, std::string_view path);

}  // namespace searchlight

// What GLSL compilers write, read. Internal to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace searchlight::gl {

struct CompileMessage {
    int line = 0, column = 0;  ///< 1-based, of the text given to the driver; 0: unknown
    std::string text;          ///< without place and severity
};

/// The errors of a compile or link log, in order; warnings are left out. Reads Mesa ("0:12(5): error: ..."), NVIDIA
/// ("0(12) : error C1008: ...") and AMD ("ERROR: 0:12: ..."); a link error has no place ("error: ...").
std::vector<CompileMessage> compileErrors(std::string_view log);

}  // namespace searchlight::gl

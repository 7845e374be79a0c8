// A compute program.
#pragma once

#include "gl/linked_program.h"

namespace searchlight::gl {

/// Work groups along each axis.
struct Groups {
    unsigned x = 1, y = 1, z = 1;
};

class Program : public LinkedProgram {
public:
    /// Compiles and links. Throws an input Error at the file, line and column of the first thing that the driver
    /// rejects. The context outlives the program.
    Program(Context& context, const Source& source);

    /// Runs work groups over the buffers and textures. Returns before they are done; Buffer::download waits. What they
    /// wrote is seen by every program, draw and download that follows. Throws what Context::checkpoint throws.
    void dispatch(const Groups& groups, std::initializer_list<Binding> buffers,
                  std::initializer_list<TextureBinding> textures = {});
    void dispatch(unsigned groups_x, std::initializer_list<Binding> buffers,
                  std::initializer_list<TextureBinding> textures = {}) {
        dispatch(Groups{groups_x, 1, 1}, buffers, textures);
    }
};

}  // namespace searchlight::gl

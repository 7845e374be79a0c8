// A program of a vertex and a fragment stage: shadow maps, G-buffers, maps in texture space.
#pragma once

#include "gl/framebuffer.h"
#include "gl/linked_program.h"

namespace searchlight::gl {

struct DrawOptions {
    unsigned triangles = 0;  ///< three vertices each, known to the shader by gl_VertexID alone
    bool depth_test = true;  ///< nearer wins; without it the last one drawn wins
    bool add = false;        ///< fragments are added to what is there; needs !depth_test to count every one
};

/// Vertices have no attributes: the vertex stage reads buffers at gl_VertexID. Depth in clip space runs from 0 to 1,
/// and y downwards: y = -1 is row 0 of the target. Both sides of a triangle are drawn.
class RasterProgram : public LinkedProgram {
public:
    /// Compiles and links. Throws an input Error at the file, line and column of the first thing that the driver
    /// rejects. The context outlives the program.
    RasterProgram(Context& context, const Source& vertex, const Source& fragment);
    ~RasterProgram();

    /// Draws all over the target. Throws what Context::checkpoint throws.
    void draw(const Framebuffer& target, const DrawOptions& options, std::initializer_list<Binding> buffers,
              std::initializer_list<TextureBinding> textures = {});

private:
    unsigned no_attributes_ = 0;
};

}  // namespace searchlight::gl

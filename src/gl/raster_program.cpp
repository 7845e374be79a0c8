#include "gl/raster_program.h"

#include <epoxy/gl.h>

namespace searchlight::gl {

namespace {

void enable(GLenum what, bool on) { on ? glEnable(what) : glDisable(what); }

}  // namespace

RasterProgram::RasterProgram(Context& context, const Source& vertex, const Source& fragment)
    : LinkedProgram(context, {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}}) {
    glCreateVertexArrays(1, &no_attributes_);
}

RasterProgram::~RasterProgram() {
    if (context_.tryMakeCurrent()) glDeleteVertexArrays(1, &no_attributes_);
}

void RasterProgram::draw(const Framebuffer& target, const DrawOptions& options, std::initializer_list<Binding> buffers,
                         std::initializer_list<TextureBinding> textures) {
    use(buffers, textures);
    glBindVertexArray(no_attributes_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.handle());
    glViewport(0, 0, target.width(), target.height());
    // From 0 to 1 keeps the precision of a depth buffer in floats.
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    enable(GL_DEPTH_TEST, options.depth_test);
    glDepthMask(options.depth_test ? GL_TRUE : GL_FALSE);
    glDepthFunc(GL_LESS);
    enable(GL_BLEND, options.add);
    glBlendFunc(GL_ONE, GL_ONE);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * options.triangles));
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    context_.checkpoint();
}

}  // namespace searchlight::gl

#include "gl/framebuffer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <cassert>

#include "base/error.h"

namespace searchlight::gl {

Framebuffer::Framebuffer(Context& context, std::initializer_list<const Texture*> colors, const Texture* depth,
                         int layer)
    : context_(context), has_depth_(depth != nullptr) {
    context_.makeCurrent();
    glCreateFramebuffers(1, &handle_);
    const auto attach = [&](GLenum point, const Texture& texture) {
        assert(width_ == 0 || (width_ == texture.width() && height_ == texture.height()));
        width_ = texture.width();
        height_ = texture.height();
        if (texture.options().cube || texture.options().layers > 1)
            glNamedFramebufferTextureLayer(handle_, point, texture.handle(), 0, layer);
        else
            glNamedFramebufferTexture(handle_, point, texture.handle(), 0);
    };
    std::vector<GLenum> outputs;
    for (const Texture* color : colors) {
        outputs.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(outputs.size()));
        attach(outputs.back(), *color);
        whole_numbers_.push_back(color->options().format == Format::r32ui);
    }
    if (depth) attach(GL_DEPTH_ATTACHMENT, *depth);
    if (outputs.empty()) outputs.push_back(GL_NONE);
    glNamedFramebufferDrawBuffers(handle_, static_cast<GLsizei>(outputs.size()), outputs.data());
    const GLenum status = glCheckNamedFramebufferStatus(handle_, GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        glDeleteFramebuffers(1, &handle_);
        throw deviceError(fmt::format("the device cannot draw to these textures (status {:#x})", status));
    }
    context_.checkpoint();
}

Framebuffer::~Framebuffer() {
    // A context that was lost has taken it along.
    if (context_.tryMakeCurrent()) glDeleteFramebuffers(1, &handle_);
}

void Framebuffer::clear() {
    context_.makeCurrent();
    glDepthMask(GL_TRUE);  // or a clear leaves the depth as it is
    constexpr std::array<GLuint, 4> zero{};
    constexpr std::array<GLfloat, 4> black{};
    constexpr GLfloat far = 1;
    for (std::size_t i = 0; i < whole_numbers_.size(); ++i) {
        if (whole_numbers_[i])
            glClearNamedFramebufferuiv(handle_, GL_COLOR, static_cast<GLint>(i), zero.data());
        else
            glClearNamedFramebufferfv(handle_, GL_COLOR, static_cast<GLint>(i), black.data());
    }
    if (has_depth_) glClearNamedFramebufferfv(handle_, GL_DEPTH, 0, &far);
    context_.checkpoint();
}

}  // namespace searchlight::gl

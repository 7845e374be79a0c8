#include "gl/program.h"

#include <epoxy/gl.h>

namespace searchlight::gl {

Program::Program(Context& context, const Source& source) : LinkedProgram(context, {{GL_COMPUTE_SHADER, source}}) {}

void Program::dispatch(const Groups& groups, std::initializer_list<Binding> buffers,
                       std::initializer_list<TextureBinding> textures) {
    use(buffers, textures);
    glDispatchCompute(groups.x, groups.y, groups.z);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    context_.checkpoint();
}

}  // namespace searchlight::gl

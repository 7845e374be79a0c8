// Any bytes as a model: parsed, its initializer split, translated. Either it works or it throws an Error with a place.
#include <cstdint>
#include <cstdlib>

#include "base/error.h"
#include "language/initializer.h"
#include "language/portable.h"

namespace {

using namespace searchlight;

void requirePlace(const Error& error) {
    if (error.kind != ErrorKind::input || error.file.empty() || error.line < 1 || error.column < 1) std::abort();
}

const PortableLibrary& library() {
    static const std::vector<GlslSource> sources = {{"l.glsl", "const float k = 1.0;\nfloat f(float x) { return x; }"}};
    static const PortableLibrary translated = translateLibrary(sources);
    return translated;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    try {
        const BssrdfFile file = parseBssrdf(text, "fuzz.bssrdf");
        const Initializer initializer = splitInitializer(file);
        // Both parts keep the section's size, so that places in them are places in the file.
        if (file.initializer.present() && (initializer.init_text.size() != file.initializer.text.size() ||
                                           initializer.functions_text.size() != file.initializer.text.size()))
            std::abort();
        if (const std::optional<Error> error = portabilityError(file, library())) requirePlace(*error);
    } catch (const Error& error) {
        requirePlace(error);
    }
    return 0;
}

#include <algorithm>
#include <cassert>

#include "base/embedded.h"
#include "language/portable.h"
#include "model/native_models.h"
#include "model/physics.h"

namespace searchlight {

namespace {

const native::NativeModel* findNative(const Model& model) {
    const std::span<const native::NativeModel> models = native::nativeModels();
    const auto found = std::ranges::find(models, model.id, &native::NativeModel::id);
    return model.shipped && found != models.end() ? &*found : nullptr;
}

PortableLibrary shippedPhysics() {
    std::vector<GlslSource> sources;
    for (const EmbeddedFile& file : embeddedFiles())
        if (file.path.starts_with("physics/")) sources.push_back({std::string(file.path), std::string(file.text)});
    return translateLibrary(sources);
}

}  // namespace

bool hasNativeEvaluator(const Model& model) {
    const auto has = [](const Model& part) { return part.measured || findNative(part); };
    return model.parts.empty() ? findNative(model) != nullptr : std::ranges::all_of(model.parts, has);
}

std::unique_ptr<Evaluator> makeNativeEvaluator(const Model& model, Precision precision) {
    if (!model.parts.empty())
        return makeSumEvaluator(model, [&](const Model& part) {
            return part.measured ? makeMeasuredEvaluator(part) : makeNativeEvaluator(part, precision);
        });
    const native::NativeModel* native = findNative(model);
    assert(native);
    return native->make(model, precision);
}

std::optional<Error> portabilityError(const BssrdfFile& file) {
    static const PortableLibrary physics = shippedPhysics();
    return portabilityError(file, physics);
}

}  // namespace searchlight

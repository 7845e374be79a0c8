#include "gui/view/reference_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "geometry/object.h"
#include "job/plot/subject.h"
#include "light/light_sampler.h"
#include "render/cell_view.h"
#include "transport/mesh/cell_picture.h"
#include "transport/mesh/reference_body.h"

namespace searchlight::gui {

namespace {

constexpr double cell_pixels = 4;              // area of a cell in pixels, as `reference mesh` has it
constexpr std::uint64_t first_walks = 20'000;  // per channel: a picture to start from in a fraction of a second

double relativeError(const Image& error, const Image& picture) {
    double squares = 0, mean = 0, count = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (picture.pixels[i].a <= 0) continue;
        const Rgba &e = error.pixels[i], &p = picture.pixels[i];
        // Channels have their own walks.
        const double deviation = std::hypot(0.2126 * e.r, 0.7152 * e.g, 0.0722 * e.b);
        squares += deviation * deviation;
        mean += luminance({p.r, p.g, p.b});
        ++count;
    }
    return mean > 0 ? std::sqrt(squares * count) / mean : 0;
}

}  // namespace

void walkPicture(const Scene& scene, int width, int height, std::uint64_t seed, std::uint64_t walks,
                 TaskContext& context, const std::function<void(ReferencePicture)>& shown) {
    Job job;
    job.scene = scene;
    const Subject subject = subjectOf(job, context.engine());
    const Object object = placeObject(scene);
    const LightSampler lights(scene, object);
    if (lights.dark()) throw inputError("there is no light for a reference");
    const View camera = makeView(scene.camera, object, width, height);
    const double pixel = 2 * camera.tan_half / camera.height * length(camera.eye);
    // Without regions walks are slower, but the first ones are seen before their tables would stand.
    const MeshBody body(object.mesh, {.cell_area_mm2 = cell_pixels * pixel * pixel, .regions = false});
    const CellView view = cellView(camera, body, subject.medium.eta);
    std::array<WalkState, Rgb::channels> states;
    std::array<std::optional<BodyResult>, Rgb::channels> channels;
    for (std::uint64_t target = std::min(first_walks, walks);; target = std::min(2 * target, walks)) {
        CellValues exitance, error;
        for (int c = 0; c < Rgb::channels; ++c) {
            if (!subject.medium.scatters(c)) continue;
            const auto i = static_cast<std::size_t>(c);
            BodyOptions options{.walks = target, .seed = seed};
            options.control.state = &states[i];
            BodyResult result = walkBody(body, subject.medium, c, &lights, options, context);
            if (result.interrupted) throw interruptedError();
            channels[i] = std::move(result);
            exitance[i] = channels[i]->exitance;
            error[i] = channels[i]->standard_error;
        }
        ReferencePicture picture;
        picture.image = std::make_shared<const Image>(pictureOfRadiance(view, exitance));
        picture.walks = target;
        picture.relative_error = relativeError(pictureOfError(view, error), *picture.image);
        shown(std::move(picture));
        if (target == walks) return;
    }
}

}  // namespace searchlight::gui

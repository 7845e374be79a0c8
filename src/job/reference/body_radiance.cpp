#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>

#include "base/error.h"
#include "base/version.h"
#include "io/image_file.h"
#include "job/json.h"
#include "job/reference/body_reference.h"
#include "job/reference/saved_walks.h"
#include "render/cell_view.h"
#include "transport/mesh/radiance_body.h"

namespace searchlight {

namespace {

CameraRays raysOf(const View& view) {
    const double pixel = 2 * view.tan_half / view.height;
    return {view.width, view.height, view.eye, view.direction(0, 0), pixel * view.right, (-pixel) * view.up};
}

using RadianceChannels = std::array<std::optional<BodyRadiance>, 3>;

template <class Body>
RadianceChannels walkRadianceChannels(const Body& body, const BodySetup& setup, SavedWalks& saved, Observer& observer) {
    const CameraRays camera = raysOf(setup.view);
    BodyRadianceOptions options{
        .seed = setup.walk.seed, .threads = setup.walk.threads, .large_steps = setup.walk.large_steps};
    const std::uint64_t pixels = camera.pixels();
    options.walks_per_pixel = std::max(std::uint64_t{1}, (setup.walk.walks + pixels / 2) / pixels);
    RadianceChannels channels;
    bool interrupted = false;
    for (int c = 0; c < Rgb::channels && !interrupted; ++c) {
        if (!setup.subject.medium.scatters(c)) continue;
        options.control = saved.control(static_cast<std::size_t>(c));
        if (options.control.until_error > 0)
            throw usageError("--until-error is about reflectance", "leave it out beside --radiance");
        BodyRadiance result = walkRadiance(body, setup.subject.medium, c, &setup.lights, camera, options, observer);
        interrupted = result.interrupted;
        if (result.walks > 0) channels[static_cast<std::size_t>(c)] = std::move(result);
    }
    if (std::ranges::none_of(channels, [](const auto& c) { return c.has_value(); })) {
        if (interrupted) throw interruptedError();
        throw inputError(fmt::format("{} does not scatter in any channel", setup.subject.name));
    }
    return channels;
}

// Values per pixel as a picture, with the part of each pixel that shows the body as its alpha.
Image pictureOf(const CellView& view, const RadianceChannels& channels, std::vector<double> BodyRadiance::*member) {
    Image image{view.width, view.height};
    for (const CellSample& sample : view.samples) image.pixels[sample.pixel].a += sample.coverage;
    for (std::size_t c = 0; c < channels.size(); ++c)
        for (std::size_t i = 0; channels[c] && i < image.pixels.size(); ++i) {
            Rgba& pixel = image.pixels[i];
            (c == 0 ? pixel.r : c == 1 ? pixel.g : pixel.b) = static_cast<float>(((*channels[c]).*member)[i]);
        }
    return image;
}

// Mean over the pixels of a picture that show the body, and its standard error.
Estimate brightnessOf(const BodyRadiance& r) {
    double sum = 0, square = 0;
    for (std::size_t i = 0; i < r.radiance.size(); ++i) {
        sum += r.radiance[i];
        square += r.standard_error[i] * r.standard_error[i];
    }
    const double n = static_cast<double>(r.radiance.size());
    return {sum / n, std::sqrt(square) / n, r.walks};
}

template <class Body>
JobResult radianceOfBody(const Job& job, const BodySetup& setup, const Body& body, std::string_view geometry,
                         Observer& observer) {
    if (setup.walk.gl) throw usageError("--radiance is walked by the CPU", "leave --backend out");
    Json problem{{"scene", Json::parse(jobJson(job)).at("scene")},
                 {"material", subjectJson(setup.subject)},
                 {"radiance", {setup.view.width, setup.view.height}},
                 {"volume_mm3", body.volume()}};
    SavedWalks saved(Options(job), job, std::move(problem), Rgb::channels, observer);
    const RadianceChannels channels = walkRadianceChannels(body, setup, saved, observer);
    JobResult result;
    saved.save(result);
    const bool interrupted = std::ranges::any_of(channels, [](const auto& c) { return c && c->interrupted; });
    Json document = documentJson("searchlight-reference/1", job);
    document["geometry"] = geometry;
    const bool beams = setup.lights.singular() || (std::is_same_v<Body, MeshBody> && setup.lights.narrow());
    document["estimator"] = setup.subject.medium.eta == 1 ? "radiance, light at each collision"
                            : beams                       ? "radiance, beams at collisions"
                                                          : "radiance, analogue";
    document["material"] = subjectJson(setup.subject);
    document["volume_mm3"] = body.volume();
    document["area_mm2"] = body.area();
    if (interrupted) document["interrupted"] = true;
    const auto list = [&](const char* name, const auto& value) {
        Json values = Json::array();
        for (const auto& channel : channels) values.push_back(channel ? Json(value(*channel)) : Json());
        document[name] = values;
    };
    list("walks", [](const BodyRadiance& r) { return r.walks; });
    list("collisions", [](const BodyRadiance& r) { return r.collisions; });
    list("surface_tests", [](const BodyRadiance& r) { return r.rays; });
    list("lost", [](const BodyRadiance& r) { return r.lost; });
    list("mirrored", [](const BodyRadiance& r) { return r.mirrored; });
    list("mirrored_orders", [](const BodyRadiance& r) { return r.orders; });
    list("mean_radiance", [](const BodyRadiance& r) { return brightnessOf(r).mean; });
    list("mean_radiance_stderr", [](const BodyRadiance& r) { return brightnessOf(r).standard_error; });
    list("seconds", [](const BodyRadiance& r) { return r.seconds; });
    if (!job.output.empty()) {
        const CellView view = cellView(setup.view, body, setup.subject.medium.eta, setup.walk.threads);
        ImageFile file;
        file.image = pictureOf(view, channels, &BodyRadiance::radiance);
        file.layers = {{"stderr", pictureOf(view, channels, &BodyRadiance::standard_error)}};
        file.metadata = {{"version", std::string(version())},
                         {"job", jobJson(job)},
                         {"seed", fmt::format("{}", job.seed)},
                         {"material", setup.subject.id},
                         {"technique", "radiance reference"},
                         {"quantity", "radiance of light that has crossed the body, without what its surface mirrors"},
                         {"totals", jsonText(document, -1)}};
        writeOutput(result, [&] { writeImage(job.output, file); });
    }
    result.json = jsonText(document);
    result.text =
        fmt::format("{}, {} in {}, radiance from the camera\n", geometry, setup.object.name, setup.subject.name);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (!channels[c]) continue;
        const BodyRadiance& r = *channels[c];
        const Estimate e = brightnessOf(r);
        result.text += fmt::format("{:<4} mean of the picture {:.6g} +- {:.2g}, {:.4g} walks, {:.3g} collisions/s\n",
                                   "RGB"[c], e.mean, e.standard_error, static_cast<double>(r.walks),
                                   static_cast<double>(r.collisions) / r.seconds);
        if (r.mirrored > 1e-4)
            result.text += fmt::format(
                "     of the light {:.2g} is mirrored inside more than {} times before it scatters, and left out\n",
                r.mirrored, r.orders);
    }
    for (const std::string& note : setup.subject.notes) result.text += note + "\n";
    result.interrupted = interrupted;
    if (interrupted) result.text += "interrupted\n";
    return result;
}

}  // namespace

JobResult radianceOf(const Job& job, const BodySetup& setup, const Ball& body, std::string_view geometry,
                     Observer& observer) {
    return radianceOfBody(job, setup, body, geometry, observer);
}

JobResult radianceOf(const Job& job, const BodySetup& setup, const MeshBody& body, std::string_view geometry,
                     Observer& observer) {
    return radianceOfBody(job, setup, body, geometry, observer);
}

}  // namespace searchlight

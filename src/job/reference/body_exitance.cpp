#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/version.h"
#include "io/image_file.h"
#include "job/json.h"
#include "job/reference/body_reference.h"
#include "job/reference/saved_walks.h"
#include "render/cell_view.h"
#include "transport/mesh/cell_picture.h"

namespace searchlight {

namespace {

using Channels = std::array<std::optional<BodyResult>, 3>;

// Channels that an interruption leaves without walks are absent.
template <class Body>
Channels walkChannels(const Body& body, const BodySetup& setup, SavedWalks& saved, Observer& observer) {
    Channels channels;
    bool any = false, interrupted = false;
    for (int c = 0; c < Rgb::channels; ++c) {
        if (!setup.subject.medium.scatters(c)) continue;
        any = true;
        if (interrupted) continue;
        BodyOptions options = setup.walk;
        options.control = saved.control(static_cast<std::size_t>(c));
        BodyResult result = walkBody(body, setup.subject.medium, c, &setup.lights, options, observer);
        interrupted = result.interrupted;
        if (result.candidates > 0) channels[static_cast<std::size_t>(c)] = std::move(result);
    }
    if (!any) throw inputError(fmt::format("{} does not scatter in any channel", setup.subject.name));
    return channels;
}

// One value per channel; null where nothing scatters.
template <class Value>
Json perChannel(const Channels& channels, const Value& value) {
    Json list = Json::array();
    for (const auto& channel : channels) list.push_back(channel ? Json(value(*channel)) : Json());
    return list;
}

Json estimates(const Channels& channels, Estimate BodyResult::*member) {
    return {{"mean", perChannel(channels, [&](const BodyResult& r) { return (r.*member).mean; })},
            {"stderr", perChannel(channels, [&](const BodyResult& r) { return (r.*member).standard_error; })}};
}

void addTotals(Json& document, const Channels& channels) {
    document["incident"] = estimates(channels, &BodyResult::incident);
    document["entered"] = estimates(channels, &BodyResult::entered);
    document["left"] = estimates(channels, &BodyResult::left);
    document["reflectance"] = estimates(channels, &BodyResult::reflectance);
    document["absorbed"] = estimates(channels, &BodyResult::absorbed);
    document["collisions_per_entry"] = estimates(channels, &BodyResult::collisions_per_entry);
    const auto list = [&](const char* name, auto BodyResult::*member) {
        document[name] = perChannel(channels, [&](const BodyResult& r) { return r.*member; });
    };
    list("walks", &BodyResult::arrivals);
    list("entries", &BodyResult::entries);
    list("collisions", &BodyResult::collisions);
    list("surface_tests", &BodyResult::rays);
    list("taken_back", &BodyResult::taken_back);
    list("lost", &BodyResult::lost);
    list("largest_weight", &BodyResult::largest_weight);
    list("seconds", &BodyResult::seconds);
}

CellValues valuesOf(const Channels& channels, std::vector<double> BodyResult::*member) {
    CellValues values;
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (channels[c]) values[c] = *channels[c].*member;
    return values;
}

std::string textOf(const BodySetup& setup, const Channels& channels) {
    std::string text =
        fmt::format("{:<4} {:>22}  {:>22}  {:>10}  {:>10}\n", "", "reflectance", "absorbed", "walks", "collisions");
    double collisions = 0, seconds = 0;
    int threads = 1;
    std::uint64_t taken_back = 0, lost = 0;
    for (int c = 0; c < Rgb::channels; ++c) {
        const auto& r = channels[static_cast<std::size_t>(c)];
        if (!r) {
            text += fmt::format(
                "{:<4} {}\n", "RGB"[c],
                setup.subject.medium.scatters(c) ? "not reached" : "not applicable: this channel does not scatter");
            continue;
        }
        const auto estimate = [](const Estimate& e) {
            return fmt::format("{:.6f} +- {:.6f}", e.mean, e.standard_error);
        };
        text +=
            fmt::format("{:<4} {:>22}  {:>22}  {:>10.4g}  {:>10.4g}\n", "RGB"[c], estimate(r->reflectance),
                        estimate(r->absorbed), static_cast<double>(r->arrivals), static_cast<double>(r->collisions));
        collisions += static_cast<double>(r->collisions);
        seconds += r->seconds;
        threads = r->threads;
        taken_back += r->taken_back;
        lost += r->lost;
    }
    text += fmt::format("{:.3g} collisions/s on {}, {:.3g} s", collisions / seconds,
                        setup.walk.gl ? "OpenGL" : fmt::format("{} threads", threads), seconds);
    if (taken_back > 0) text += fmt::format("; {} walks taken back inside", taken_back);
    if (lost > 0) text += fmt::format("; {} walks lost by rounding", lost);
    text += "\n";
    for (const std::string& note : setup.subject.notes) text += note + "\n";
    return text;
}

template <class Body>
JobResult exitanceOfBody(const Job& job, const BodySetup& setup, const Body& body, std::string_view geometry,
                         Observer& observer) {
    Json problem{{"scene", Json::parse(jobJson(job)).at("scene")},
                 {"material", subjectJson(setup.subject)},
                 {"cells", body.cellCount()},
                 {"area_mm2", body.area()},
                 {"volume_mm3", body.volume()}};
    if (setup.walk.gl) problem["backend"] = "gl";
    SavedWalks saved(Options(job), job, std::move(problem), Rgb::channels, observer);
    const Channels channels = walkChannels(body, setup, saved, observer);
    JobResult result;
    saved.save(result);
    const bool interrupted = std::ranges::any_of(channels, [](const auto& c) { return c && c->interrupted; });
    if (std::ranges::none_of(channels, [](const auto& c) { return c.has_value(); })) throw interruptedError();
    Json document = documentJson("searchlight-reference/1", job);
    document["per"] = "incident";
    document["geometry"] = geometry;
    document["estimator"] = "exitance, analogue";
    document["backend"] = setup.walk.gl ? "gl" : "cpu";
    document["material"] = subjectJson(setup.subject);
    document["volume_mm3"] = body.volume();
    document["area_mm2"] = body.area();
    document["cells"] = body.cellCount();
    if (interrupted) document["interrupted"] = true;
    addTotals(document, channels);

    if (!job.output.empty()) {
        const CellView view = cellView(setup.view, body, setup.subject.medium.eta, setup.walk.threads);
        const CellValues exitance = valuesOf(channels, &BodyResult::exitance);
        ImageFile file;
        file.image = pictureOfRadiance(view, exitance);
        file.layers = {{"stderr", pictureOfError(view, valuesOf(channels, &BodyResult::standard_error))},
                       {"exitance", pictureOfExitance(view, exitance)},
                       {"cell", pictureOfCells(view)}};
        file.metadata = {{"version", std::string(version())},
                         {"job", jobJson(job)},
                         {"seed", fmt::format("{}", job.seed)},
                         {"material", setup.subject.id},
                         {"technique", "exitance reference"},
                         {"quantity",
                          "diffuse exit: T21 M / (pi 4 C_phi(1/eta)), "
                          "M a mean over surface cells"},
                         {"totals", jsonText(document, -1)}};
        writeOutput(result, [&] { writeImage(job.output, file); });
    }
    result.json = jsonText(document);
    result.text = fmt::format("{}, {} in {}, {} cells, per unit incident flux\n", geometry, setup.object.name,
                              setup.subject.name, body.cellCount()) +
                  textOf(setup, channels);
    result.interrupted = interrupted;
    if (interrupted) result.text += "interrupted\n";
    return result;
}

}  // namespace

JobResult exitanceOf(const Job& job, const BodySetup& setup, const Ball& body, std::string_view geometry,
                     Observer& observer) {
    return exitanceOfBody(job, setup, body, geometry, observer);
}

JobResult exitanceOf(const Job& job, const BodySetup& setup, const MeshBody& body, std::string_view geometry,
                     Observer& observer) {
    return exitanceOfBody(job, setup, body, geometry, observer);
}

}  // namespace searchlight

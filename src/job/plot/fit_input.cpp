#include "job/plot/fit_input.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/files.h"
#include "job/json.h"
#include "model/plane.h"

namespace searchlight {

namespace {

// The document of a reference holds means over annuli, that of `profile` values at points.
ProfileData parseDocument(const std::string& text, const std::string& path, const std::string& order) {
    const Json document = Json::parse(text);
    const std::string format = document.at("format");
    const bool walked = format == "searchlight-reference/1";
    if (!walked && format != "searchlight-profile/1")
        throw inputError(fmt::format("'{}' is no profile", format),
                         "expected searchlight-reference/1 or searchlight-profile/1");
    if (!walked && order != "all")
        throw inputError(fmt::format("a profile does not tell {} scattering from the rest", order),
                         "--order is for documents of reference halfspace");
    if (walked && document.value("geometry", "") != "halfspace")
        throw inputError("the walks were not in a half-space", "expected a document of reference halfspace");
    if (document.value("angle_deg", 0.0) != 0)
        throw inputError("the beam was oblique", "a fit needs a profile at normal incidence");
    if (document.contains("beam") && document.at("beam").at("radius_mm") != 0.0)
        throw inputError("the beam was wide", "a fit needs a profile of a pencil beam");
    const Json& material = document.at("material");
    ProfileData profile;
    profile.title = material.value("name", path);
    profile.eta = material.at("eta");
    const double entered = document.at("per") == "incident" ? pencilBeam(profile.eta, 0).transmittance : 1;
    const Json& light = order == "all" ? document : document.at(order);
    const Json& table = walked ? light.at("profile") : document;
    FitData radii;
    if (walked) {
        radii.edges_mm = table.at("edges_mm").get<std::vector<double>>();
        for (std::size_t i = 0; i + 1 < radii.edges_mm.size(); ++i) {
            if (radii.edges_mm[i] < 0 || radii.edges_mm[i + 1] <= radii.edges_mm[i])
                throw inputError("the edges of the annuli do not ascend", "edges are at least 0 and grow");
            radii.radii_mm.push_back(0.5 * (radii.edges_mm[i] + radii.edges_mm[i + 1]));
        }
    } else
        radii.radii_mm = table.at("radii_mm").get<std::vector<double>>();
    for (std::size_t i = 0; i < radii.radii_mm.size(); ++i)
        if (radii.radii_mm[i] < 0 || (i > 0 && radii.radii_mm[i] <= radii.radii_mm[i - 1]))
            throw inputError("the radii do not ascend", "radii are at least 0 and grow");
    const Json& rows = table.at("Rd");
    if (rows.size() != 1 && rows.size() != 3)
        throw inputError(fmt::format("the profile has {} channels", rows.size()), "expected 1 or 3");
    for (std::size_t c = 0; c < rows.size(); ++c) {
        FitData data = radii;
        if (rows.at(c).empty() || rows.at(c).at(0).is_null())
            throw inputError(fmt::format("channel {} does not scatter", c), "a fit needs values in every channel");
        data.value = rows.at(c).get<std::vector<double>>();
        if (walked) data.standard_error = table.at("stderr").at(c).get<std::vector<double>>();
        if (data.value.size() != data.radii_mm.size() || (walked && data.standard_error.size() != data.value.size()))
            throw inputError("the profile's lists differ in length");
        for (std::size_t i = 0; i < data.value.size(); ++i) {
            data.value[i] /= entered;
            if (walked) data.standard_error[i] /= entered;
        }
        profile.channels.push_back(std::move(data));
    }
    return profile;
}

}  // namespace

ProfileData readFitInput(const std::string& path, const std::string& order) {
    const std::string text = readFile(path);
    const bool csv = !path.ends_with(".json");
    if (csv && order != "all")
        throw inputError(fmt::format("a table does not tell {} scattering from the rest", order),
                         "--order is for documents of reference halfspace")
            .at(path);
    if (csv) return parseProfileData(text, path);
    try {
        return parseDocument(text, path, order);
    } catch (const Error& error) {
        throw error.at(path);
    } catch (const Json::exception&) {
        throw inputError("no profile", "expected the document that `reference halfspace` or `profile` writes").at(path);
    }
}

}  // namespace searchlight

// doctor: what this machine has, what is missing, and what mends it.
#include <fmt/core.h>
#include <fmt/format.h>

#include "base/parallel.h"
#include "base/text.h"
#include "base/version.h"
#include "draw/draw.h"
#include "gl/context.h"
#include "job/command_table.h"
#include "job/json.h"

namespace searchlight {

namespace {

std::vector<std::string> instructionSets() {
    std::vector<std::string> found;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
        found.emplace_back("AVX-512");
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) found.emplace_back("AVX2");
    if (__builtin_cpu_supports("sse4.2")) found.emplace_back("SSE4");
#endif
    if (found.empty()) found.emplace_back("baseline");
    return found;
}

JobResult runDoctor(const Job& job, Engine&, Observer&) {
    Json document = documentJson("searchlight-doctor/1", job);
    JobResult result;
    const auto line = [&](bool good, std::string_view what, const std::string& text) {
        result.text += fmt::format("{} {:<12} {}\n", good ? "ok " : "-- ", what, text);
    };
    line(true, "searchlight", std::string(version()));
    line(true, "compiler", fmt::format("{}, {}", __VERSION__, sizeof(void*) == 8 ? "64 bit" : "32 bit"));
    const std::vector<std::string> sets = instructionSets();
    line(true, "CPU", join(sets, ", "));
    line(true, "threads", fmt::format("{}", hardwareThreads()));

    document["gl"] = Json::array();
    bool any = false;
    for (const gl::DeviceReport& report : gl::probe()) {
        any |= report.works;
        Json json{{"platform", report.platform}, {"works", report.works}};
        if (report.works) {
            json["renderer"] = report.info.renderer;
            json["version"] = report.info.version;
            json["hardware"] = report.info.hardware;
            line(true, "OpenGL",
                 fmt::format("{}: {}, {}{}", report.platform, report.info.renderer, report.info.version,
                             report.info.hardware ? "" : " (software)"));
        } else {
            json["problem"] = report.problem;
            json["hint"] = report.hint;
            line(false, "OpenGL",
                 fmt::format("{}: {}{}", report.platform, report.problem,
                             report.hint.empty() ? "" : "\n                " + report.hint));
        }
        document["gl"].push_back(std::move(json));
    }
    if (!any)
        result.text +=
            "   Without OpenGL the shipped models still run on the CPU; models of your own need it:\n"
            "   apt-get install libegl1 libgl1-mesa-dri libopengl0 libepoxy0\n";
    const std::vector<std::string> formats = figureFormats();
    const bool qt = std::find(formats.begin(), formats.end(), ".pdf") != formats.end();
    line(qt, "figures",
         join(formats, ", ") +
             (qt ? ""
                 : "\n                .png and .pdf: apt-get install qt6-base-dev qt6-svg-dev, build with "
                   "SEARCHLIGHT_QT=ON"));
    line(true, "libraries",
         fmt::format("fmt {}.{}, nlohmann-json {}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
                     NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR));
    document["instruction_sets"] = sets;
    document["threads"] = hardwareThreads();
    document["figure_formats"] = formats;
    result.passed = any;
    result.json = jsonText(document);
    return result;
}

}  // namespace

Command doctorCommand() {
    return {.name = "doctor",
            .summary = "Say what this machine has and what is missing",
            .example = "searchlight doctor",
            .run = runDoctor};
}

}  // namespace searchlight

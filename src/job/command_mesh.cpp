// mesh: what a mesh is like, and in another format.
#include <fmt/format.h>

#include "base/text.h"
#include "geometry/mesh_report.h"
#include "geometry/object.h"
#include "io/shape_file.h"
#include "job/command_table.h"
#include "job/json.h"

namespace searchlight {

namespace {

std::string lengthsText(Vec3 a) {
    return fmt::format("{} {} {}", prettyNumber(a.x), prettyNumber(a.y), prettyNumber(a.z));
}

std::string textOf(const MeshReport& report, const std::vector<std::string>& faults) {
    std::string text;
    const auto line = [&](std::string_view name, const std::string& value) {
        text += fmt::format("{:<12}{}\n", name, value);
    };
    line("triangles", fmt::format("{}", report.triangles));
    line("vertices", fmt::format("{}, {} positions", report.vertices, report.welded_vertices));
    line("closed", report.closed ? fmt::format("yes, genus {}", report.genus()) : std::string("no"));
    line("components", fmt::format("{}, Euler characteristic {}", report.components, report.euler));
    line("box", fmt::format("{} to {}", lengthsText(report.low), lengthsText(report.high)));
    line("area", prettyNumber(report.area, 6));
    line("volume", report.closed ? prettyNumber(report.volume, 6) : std::string("of an open mesh: none"));
    line("normals", report.normals ? "yes" : "no");
    line("uvs", report.uvs ? "yes" : "no");
    line("unit", unitsHint(report));
    for (const std::string& fault : faults) line("fault", fault);
    return text;
}

Json jsonOf(const MeshReport& report, const std::vector<std::string>& faults) {
    const auto list = [](Vec3 a) { return Json{a.x, a.y, a.z}; };
    Json json{{"triangles", report.triangles},
              {"vertices", report.vertices},
              {"positions", report.welded_vertices},
              {"closed", report.closed},
              {"components", report.components},
              {"euler", report.euler},
              {"genus", nullptr},
              {"boundary_edges", report.boundary_edges},
              {"nonmanifold_edges", report.nonmanifold_edges},
              {"misoriented_edges", report.misoriented_edges},
              {"degenerate_triangles", report.degenerate_triangles},
              {"unreferenced_vertices", report.unreferenced_vertices},
              {"opposed_normals", report.opposed_normals},
              {"low", list(report.low)},
              {"high", list(report.high)},
              {"area", report.area},
              {"volume", nullptr},
              {"normals", report.normals},
              {"uvs", report.uvs},
              {"faults", faults}};
    if (report.closed) json["genus"] = report.genus(), json["volume"] = report.volume;
    return json;
}

JobResult runMesh(const Job& job, Engine&, Observer&) {
    const std::string& path = Options(job).text("mesh");
    const Mesh mesh = meshNamed(path);
    const MeshReport report = reportMesh(mesh);
    const std::vector<std::string> faults = faultsOf(report);
    if (!job.output.empty()) writeMesh(job.output, mesh);
    Json document = documentJson("searchlight-mesh/1", job);
    document["mesh"] = jsonOf(report, faults);
    return {.text = textOf(report, faults), .json = document.dump(1)};
}

}  // namespace

Command meshCommand() {
    return {.name = "mesh",
            .summary = "Say whether a mesh is closed, which way it faces, how large it is; convert it",
            .example = "searchlight mesh statue -o statue.ply",
            .options = {{.name = "mesh",
                         .type = ParamType::path,
                         .doc = "a file, or a built-in object: " + join(builtInObjects(), ", "),
                         .required = true}},
            .positional = "mesh",
            .output = "the mesh: .ply or .obj",
            .run = runMesh};
}

}  // namespace searchlight

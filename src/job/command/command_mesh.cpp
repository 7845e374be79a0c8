// mesh: what a mesh is like, in another format, with an atlas.
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "geometry/atlas/atlas.h"
#include "geometry/mesh_report.h"
#include "geometry/object.h"
#include "io/image_file.h"
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

std::string textOf(const AtlasReport& atlas) {
    return fmt::format(
        "{:<12}{} charts{}, {:.0f} % of the square, stretch L2 {:.4f}, at most {:.2f}; areas off by {:.1f} % (RMS), a "
        "texel "
        "stands for up to {:.2f} times the mean\n{}",
        "atlas", atlas.charts, atlas.from_file ? " of the mesh's own uvs" : "", 100 * atlas.fill, atlas.stretch.l2,
        atlas.stretch.worst, 100 * atlas.stretch.area_rms, atlas.stretch.largest_area,
        atlas.fault.empty() ? "" : fmt::format("{:<12}of the mesh refused: {}\n", "uvs", atlas.fault));
}

Json jsonOf(const AtlasReport& atlas) {
    Json json{{"charts", atlas.charts},
              {"from_file", atlas.from_file},
              {"fill", atlas.fill},
              {"stretch_l2", atlas.stretch.l2},
              {"stretch_worst", atlas.stretch.worst},
              {"area_distortion", atlas.stretch.area_rms},
              {"largest_area", atlas.stretch.largest_area},
              {"refused", nullptr}};
    if (!atlas.fault.empty()) json["refused"] = atlas.fault;
    return json;
}

JobResult runMesh(const Job& job, Engine&, Observer& observer) {
    const Options options(job);
    Mesh mesh = meshNamed(options.text("mesh"));
    const MeshReport report = reportMesh(mesh);
    const std::vector<std::string> faults = faultsOf(report);
    Json document = documentJson("searchlight-mesh/1", job);
    document["mesh"] = jsonOf(report, faults);
    std::string text = textOf(report, faults);
    if (const auto side = static_cast<int>(options.number("atlas")); side > 0) {
        const std::string& uvs = options.text("uvs");
        const Atlas atlas = makeAtlas(mesh,
                                      {.resolution = side,
                                       .conformal = uvs == "conformal",
                                       .uvs = uvs == "automatic" ? AtlasUvs::automatic
                                              : uvs == "file"    ? AtlasUvs::file
                                                                 : AtlasUvs::own},
                                      observer);
        document["atlas"] = jsonOf(atlas.report);
        text += textOf(atlas.report);
        if (const std::string& picture = options.text("picture"); !picture.empty())
            writeImage(picture, {atlasPicture(mesh, atlas, std::max(1, 1024 / side))});
        mesh = withAtlasUvs(mesh, atlas);
    } else if (options.given("uvs") || options.given("picture")) {
        throw usageError("--uvs and --picture are about an atlas", "--atlas 256 makes one");
    }
    if (!job.output.empty()) writeMesh(job.output, mesh);
    return {.text = text, .json = jsonText(document)};
}

}  // namespace

Command meshCommand() {
    return {
        .name = "mesh",
        .summary = "Say whether a mesh is closed, which way it faces, how large it is; convert it, or give it an atlas",
        .example = "searchlight mesh statue -o statue.ply",
        .options = {{.name = "mesh",
                     .type = ParamType::path,
                     .doc = "a file, or a built-in object: " + join(builtInObjects(), ", "),
                     .required = true},
                    {.name = "atlas",
                     .type = ParamType::integer,
                     .min = 0,
                     .max = 4096,
                     .value = 0.0,
                     .doc = "texels along a side of an atlas that the mesh gets as its uvs; 0: none"},
                    {.name = "uvs",
                     .type = ParamType::choice,
                     .value = std::string("automatic"),
                     .choices = {"automatic", "own", "file", "conformal"},
                     .doc = "of the atlas: the mesh's where they are sound, always own charts, always the mesh's, or "
                            "few charts that keep angles and not areas"},
                    {.name = "picture",
                     .type = ParamType::text,
                     .value = std::string(),
                     .doc = "of the atlas: charts in colours, darker where a texel stands for more surface; a .png"}},
        .positional = "mesh",
        .output = "the mesh: .ply or .obj",
        .run = runMesh};
}

}  // namespace searchlight

// bench transport: how fast the half-space is walked, and what that is worth.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <limits>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "job/command_table.h"
#include "job/json.h"
#include "transport/half_space/half_space.h"
#include "transport/half_space/half_space_walk.h"
#include "transport/slab/slab.h"

namespace searchlight {

namespace {

struct Case {
    const char* name;
    HalfSpaceProblem problem;
};

// Jensen 2001: published reduced coefficients, taken with g = 0. Then forward scattering and oblique incidence.
constexpr Case cases[] = {
    {"marble, red", {.sigma_a = 0.0021, .sigma_s = 2.19, .eta = 1.5}},
    {"skin1, red", {.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3}},
    {"ketchup, blue", {.sigma_a = 1.45, .sigma_s = 0.03, .eta = 1.3}},
    {"whole milk, green", {.sigma_a = 0.0024, .sigma_s = 3.21, .eta = 1.3}},
    {"g = 0.9", {.sigma_a = 0.01, .sigma_s = 10, .g = 0.9, .eta = 1.4}},
    {"skin1, red, 60 deg", {.sigma_a = 0.032, .sigma_s = 0.74, .eta = 1.3, .angle_deg = 60}},
};
constexpr std::array<double, 5> radii{0.5, 1, 2, 5, 10};  // in reduced mean free paths
constexpr int bins_to_5 = 53, bins_to_10 = 103;           // of 0.1, two more than the last radius needs
constexpr std::uint64_t first_walks = 200'000;

struct Timed {
    HalfSpaceResult result;
    double seconds = 0;  // of the CPU; of the clock on the wall where OpenGL walks
};

Timed walkTimed(const HalfSpaceProblem& problem, const HalfSpaceOptions& options, Observer& observer) {
    const std::clock_t begin = std::clock();
    Timed timed{walkHalfSpace(problem, options, observer)};
    timed.seconds = options.gl ? timed.result.seconds : static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    return timed;
}

// As many walks as take about so long, after a first run that finds out how many those are.
Timed walkFor(double seconds, const HalfSpaceProblem& problem, HalfSpaceOptions options, Observer& observer) {
    const std::uint64_t first = options.gl ? first_walks / 20 : first_walks;  // it may be a software driver
    options.walks = first;
    const double once = std::max(walkTimed(problem, options, observer).seconds, 1e-4);
    options.walks = static_cast<std::uint64_t>(std::max(1.0, seconds / once) * static_cast<double>(first));
    return walkTimed(problem, options, observer);
}

// 1 / (relative variance x CPU seconds); null of what has no error or no value.
Json meritOf(const Estimate& estimate, double cpu_seconds) {
    if (estimate.mean == 0 || estimate.standard_error == 0) return nullptr;
    const double relative = estimate.standard_error / estimate.mean;
    return 1 / (relative * relative * cpu_seconds);
}

// That of bins of 0.1 reduced mean free paths; the relative variance is the mean over
// five neighbours, since each is known to some 10 % from the scatter of the chunks. Null where a bin has seen nothing.
Json meritAt(double radius, const Timed& timed) {
    const HalfSpaceTally& tally = timed.result.all;
    const auto middle = static_cast<std::size_t>(10 * radius + 0.5);
    if (middle + 2 >= tally.Rd.size()) return nullptr;
    double relative_variance = 0;
    for (std::size_t i = middle - 2; i <= middle + 2; ++i) {
        if (tally.Rd[i] == 0) return nullptr;
        const double relative = tally.standard_error[i] / tally.Rd[i];
        relative_variance += relative * relative / 5;
    }
    return 1 / (relative_variance * timed.seconds);
}

// Who walks: an estimator on one thread of the CPU, or the analogue on OpenGL.
struct Walker {
    const char* name;
    Estimator estimator;
    gl::Context* gl = nullptr;
};

Json rowJson(const Case& one, const Walker& walker, int bins, double seconds, std::uint64_t seed, Observer& observer) {
    const HalfSpaceProblem& problem = one.problem;
    const double mfp = 1 / (problem.sigma_a + (1 - problem.g) * problem.sigma_s);
    HalfSpaceOptions options;
    options.seed = seed;
    options.threads = 1;
    options.estimator = walker.estimator;
    options.gl = walker.gl;
    for (int i = 0; i <= bins; ++i) options.edges_mm.push_back(0.1 * i * mfp);
    const Timed timed = walkFor(seconds, problem, options, observer);
    const HalfSpaceResult& result = timed.result;
    Json row{{"case", one.name},
             {"estimator", walker.name},
             {"walked_by", result.estimator == Estimator::best ? "best" : "analogue"},
             {"instruction_set", result.instruction_set},
             {"bins_to_mfp", 0.1 * bins},
             {"walks_per_s", static_cast<double>(result.walks) / timed.seconds},
             {"collisions_per_s", static_cast<double>(result.collisions) / timed.seconds}};
    for (const double radius : radii) row["merit"].push_back(meritAt(radius, timed));
    const Estimate& total = result.all.total;
    row["merit_total"] = meritOf(total, timed.seconds);
    row["merit_r2"] = meritOf(result.all.mean_r2_mm2, timed.seconds);
    row[walker.gl ? "wall_seconds" : "cpu_seconds"] = timed.seconds;
    return row;
}

struct SlabCase {
    const char* name;
    SlabProblem problem;
    double step_mm;  ///< width of the annuli
};

// MCML's sample of three layers; a thin sheet; marble; two layers of unlike indices; strong forward scattering.
std::vector<SlabCase> slabCases() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return {{"three layers, n 1.37",
             {.layers = {{.n = 1.37, .sigma_a = 0.1, .sigma_s = 10, .g = 0.9, .thickness_mm = 1},
                         {.n = 1.37, .sigma_a = 0.1, .sigma_s = 1, .thickness_mm = 1},
                         {.n = 1.37, .sigma_a = 0.2, .sigma_s = 1, .g = 0.7, .thickness_mm = 2}}},
             0.1},
            {"sheet, g 0.75", {.layers = {{.sigma_a = 1, .sigma_s = 9, .g = 0.75, .thickness_mm = 0.2}}}, 0.02},
            {"marble, 10 mm", {.layers = {{.n = 1.5, .sigma_a = 0.0021, .sigma_s = 2.19, .thickness_mm = 10}}}, 0.0456},
            {"skin1 on bone, 30 deg",
             {.layers = {{.n = 1.3, .sigma_a = 0.032, .sigma_s = 0.74, .thickness_mm = 2},
                         {.n = 1.5, .sigma_a = 0.01, .sigma_s = 3, .g = 0.5, .thickness_mm = 2}},
              .angle_deg = 30},
             0.13},
            {"half-space, g 0.9",
             {.layers = {{.n = 1.4, .sigma_a = 0.01, .sigma_s = 10, .g = 0.9, .thickness_mm = infinity}}},
             0.1}};
}

// Merits of R, T and A, of R(r) and T(r) at 5, 10, 20 and 50 annuli, of angles at 45 degrees, and of A(z) at a tenth
// of the depth that is tallied.
Json slabRow(const SlabCase& one, SlabEstimator estimator, double seconds, std::uint64_t seed, Observer& observer) {
    SlabOptions options;
    options.estimator = estimator;
    options.seed = seed;
    options.threads = 1;
    for (int i = 0; i <= bins_to_5; ++i) options.edges_mm.push_back(one.step_mm * i);
    options.depth_mm = one.step_mm * options.depths;
    const auto timed = [&](std::uint64_t walks) {
        options.walks = walks;
        const std::clock_t begin = std::clock();
        SlabResult result = walkSlab(one.problem, options, observer);
        return std::pair(std::move(result), static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    };
    const double once = std::max(timed(first_walks).second, 1e-4);
    const auto [result, spent] =
        timed(static_cast<std::uint64_t>(std::max(1.0, seconds / once) * static_cast<double>(first_walks)));
    Json row{{"case", one.name},
             {"estimator", estimator == SlabEstimator::best ? "best" : "analogue"},
             {"walked_by", result.foresees ? "best" : "analogue"},
             {"walks_per_s", static_cast<double>(result.walks) / spent},
             {"collisions_per_s", static_cast<double>(result.collisions) / spent}};
    row["merit_R"] = meritOf(result.R, spent);
    row["merit_T"] = meritOf(result.T, spent);
    row["merit_A"] = meritOf(result.A, spent);
    for (const std::size_t bin : {5, 10, 20, 50}) {
        row["merit_R_r"].push_back(meritOf({result.R_r.mean[bin], result.R_r.standard_error[bin], 0}, spent));
        row["merit_T_r"].push_back(meritOf({result.T_r.mean[bin], result.T_r.standard_error[bin], 0}, spent));
    }
    const auto middle = [&, spent = spent](const SlabSeries& series, std::size_t i) {
        return meritOf({series.mean[i], series.standard_error[i], 0}, spent);
    };
    row["merit_R_a"] = middle(result.R_a, result.R_a.mean.size() / 2);
    row["merit_T_a"] = middle(result.T_a, result.T_a.mean.size() / 2);
    row["merit_A_z"] = middle(result.A_z, result.A_z.mean.size() / 10);
    row["cpu_seconds"] = spent;
    return row;
}

// Wall time of one thread over that of all, on the same walks: the median of pairs in turns, of each estimator.
double speedup(Estimator estimator, double seconds, Observer& observer) {
    constexpr std::size_t pairs = 5;
    HalfSpaceOptions options;
    for (int i = 0; i <= bins_to_5; ++i) options.edges_mm.push_back(0.0456 * i);
    options.estimator = estimator;
    options.threads = 1;
    options.walks = walkFor(seconds / pairs, cases[0].problem, options, observer).result.walks;
    std::array<double, pairs> ratios{};
    for (double& ratio : ratios) {
        options.threads = 1;
        const double one = walkTimed(cases[0].problem, options, observer).result.seconds;
        options.threads = 0;
        ratio = one / walkTimed(cases[0].problem, options, observer).result.seconds;
    }
    std::ranges::nth_element(ratios, ratios.begin() + pairs / 2);
    return ratios[pairs / 2];
}

std::string meritText(const Json& merit) { return merit.is_null() ? "-" : fmt::format("{:.3g}", merit.get<double>()); }

// Of a row's own walks nothing is said, but they stop when asked to.
class Quiet : public Observer {
public:
    explicit Quiet(const Observer& observer) : observer_(observer) {}
    bool cancelled() const override { return observer_.cancelled(); }

private:
    const Observer& observer_;
};

JobResult runBenchTransport(const Job& job, Engine& engine, Observer& observer) {
    const Options options(job);
    const double seconds = options.number("seconds");
    std::vector<Walker> walkers{{"analogue", Estimator::analogue}, {"best", Estimator::best}};
    if (options.text("backend") == "gl") walkers.push_back({"gl", Estimator::analogue, &engine.context()});
    Json document = documentJson("searchlight-bench/1", job);
    document["bench"] = "transport";
    document["radii_mfp"] = radii;
    document["merit"] =
        "1 / (relative variance x CPU seconds) of bins of 0.1 reduced mean free paths, one thread; of gl: x seconds of "
        "the device";
    JobResult result;
    result.text = fmt::format("{:20} {:10} {:>9} {:>12}  figure of merit at r =\n{:20} {:10} {:>9} {:>12}", "", "",
                              "walks/s", "collisions/s", "", "", "", "");
    for (const double radius : radii) result.text += fmt::format(" {:>9}", radius);
    result.text += fmt::format(" {:>9}\n", "total");
    const std::vector<SlabCase> slabs = slabCases();
    const std::uint64_t total = std::size(cases) * 2 * walkers.size() + 2 * slabs.size();
    std::uint64_t done = 0;
    Quiet quiet(observer);
    for (const Case& one : cases)
        for (const int bins : {bins_to_5, bins_to_10})
            for (const Walker& walker : walkers) {
                if (observer.cancelled()) throw interruptedError();
                observer.progress("bench", done++, total, "rows");
                Json row = rowJson(one, walker, bins, seconds, job.seed, quiet);
                document["instruction_set"] = halfSpaceInstructionSet();
                result.text +=
                    fmt::format("{:20} {:10} {:9.3g} {:12.3g}", one.name, row["estimator"].get<std::string>(),
                                row["walks_per_s"].get<double>(), row["collisions_per_s"].get<double>());
                for (const Json& merit : row["merit"]) result.text += fmt::format(" {:>9}", meritText(merit));
                result.text += fmt::format(" {:>9}\n", meritText(row["merit_total"]));
                document["rows"].push_back(std::move(row));
            }
    result.text += fmt::format(
        "{:20} {:10} {:>9} {:>12} {:>9} {:>9} {:>9}  R(r) and T(r) of annuli 5, 10, 20, 50; R, T at 45 deg; A(z)\n",
        "slab", "", "walks/s", "collisions/s", "merit R", "T", "A");
    for (const SlabCase& one : slabs)
        for (const SlabEstimator estimator : {SlabEstimator::analogue, SlabEstimator::best}) {
            if (observer.cancelled()) throw interruptedError();
            observer.progress("bench", done++, total, "rows");
            Json row = slabRow(one, estimator, seconds, job.seed, quiet);
            result.text += fmt::format("{:20} {:10} {:9.3g} {:12.3g} {:>9} {:>9} {:>9}", one.name,
                                       row["estimator"].get<std::string>(), row["walks_per_s"].get<double>(),
                                       row["collisions_per_s"].get<double>(), meritText(row["merit_R"]),
                                       meritText(row["merit_T"]), meritText(row["merit_A"]));
            for (const char* series : {"merit_R_r", "merit_T_r"})
                for (const Json& merit : row[series]) result.text += fmt::format(" {:>8}", meritText(merit));
            for (const char* one_number : {"merit_R_a", "merit_T_a", "merit_A_z"})
                result.text += fmt::format(" {:>8}", meritText(row[one_number]));
            result.text += "\n";
            document["slabs"].push_back(std::move(row));
        }
    document["threads"] = hardwareThreads();
    document["speedup"] = speedup(Estimator::analogue, seconds, quiet);
    document["speedup_best"] = speedup(Estimator::best, seconds, quiet);
    result.text += fmt::format("{} threads walk {:.2f} times as fast as one, best {:.2f} times ({})\n",
                               hardwareThreads(), document["speedup"].get<double>(),
                               document["speedup_best"].get<double>(), document["instruction_set"].get<std::string>());
    result.json = jsonText(document);
    writeDocument(result, job);
    return result;
}

}  // namespace

Command benchTransportCommand() {
    return {
        .name = "bench transport",
        .summary = "Time the walks of half-space and slabs, and say what each estimator is worth",
        .example = "searchlight bench transport --json",
        .options =
            {{.name = "seconds", .unit = "s", .min = 0.01, .max = 3600, .value = 2.0, .doc = "CPU time of each row"},
             {.name = "backend",
              .type = ParamType::choice,
              .value = std::string("cpu"),
              .choices = {"cpu", "gl"},
              .doc = "gl: rows of the walk on OpenGL, too"}},
        .uses_seed = true,
        .output = "the JSON document",
        .run = runBenchTransport};
}

}  // namespace searchlight

#include "transport/mcml/mcml_file.h"

#include <fmt/format.h>

#include <set>

#include "base/text.h"
#include "transport/mcml/data_lines.h"
#include "transport/mcml/mci_version_2.h"

namespace searchlight {

namespace {

McmlRun readRun(DataLines& lines) {
    McmlRun run;
    const std::vector<Word>& name = lines.take(2, "output file and format");
    run.output = name[0].text;
    const std::string_view format = name[1].text;
    if (format != "A" && format != "a" && format != "B" && format != "b")
        throw lines.error(name[1], fmt::format("unknown format '{}'", format), "A or B");
    run.format = format == "B" || format == "b" ? 'B' : 'A';
    run.photons =
        static_cast<std::uint64_t>(lines.whole(lines.take(1, "number of photons")[0], "the number of photons", 1e15));
    const std::vector<Word>& steps = lines.take(2, "dz dr");
    run.dz = lines.positive(steps[0], "dz");
    run.dr = lines.positive(steps[1], "dr");
    const std::vector<Word>& counts = lines.take(3, "nz nr na");
    run.nz = static_cast<int>(lines.whole(counts[0], "nz", kMostMcmlCells));
    run.nr = static_cast<int>(lines.whole(counts[1], "nr", kMostMcmlCells));
    run.na = static_cast<int>(lines.whole(counts[2], "na", kMostMcmlCells));
    const double layers = lines.whole(lines.take(1, "number of layers")[0], "the number of layers", kMostMcmlCells);
    run.n_above = lines.positive(lines.take(1, "n above")[0], "n above");
    while (run.layers.size() < static_cast<std::size_t>(layers)) {
        const std::vector<Word>& words = lines.take(5, fmt::format("n mua mus g d of layer {}", run.layers.size() + 1));
        McmlLayer layer;
        layer.n = lines.positive(words[0], "n");
        layer.mua = lines.number(words[1], "mua", 0, 1e15);
        layer.mus = lines.number(words[2], "mus", 0, 1e15);
        layer.g = lines.number(words[3], "g", -1, 1);
        layer.d = lines.number(words[4], "d", 0, 1e15);
        run.layers.push_back(layer);
    }
    run.n_below = lines.positive(lines.take(1, "n below")[0], "n below");
    return run;
}

std::string runText(const McmlRun& run) {
    std::string text = fmt::format("{}\t{}\t\t\t# output file, ASCII or binary\n{}\t\t\t\t# photons\n", run.output,
                                   run.format, run.photons);
    text += fmt::format("{}\t{}\t\t\t# dz, dr [cm]\n{}\t{}\t{}\t\t# nz, nr, na\n\n", numberText(run.dz),
                        numberText(run.dr), run.nz, run.nr, run.na);
    text += fmt::format("{}\t\t\t\t# layers\n#n\tmua\tmus\tg\td\n{}\t\t\t\t# n above\n", run.layers.size(),
                        numberText(run.n_above));
    for (std::size_t i = 0; i < run.layers.size(); ++i) {
        const McmlLayer& layer = run.layers[i];
        text += fmt::format("{}\t{}\t{}\t{}\t{}\t# layer {}\n", numberText(layer.n), numberText(layer.mua),
                            numberText(layer.mus), numberText(layer.g), numberText(layer.d), i + 1);
    }
    return text + fmt::format("{}\t\t\t\t# n below\n\n", numberText(run.n_below));
}

struct Block {
    std::string_view name, comment;
    std::vector<double> McmlOutput::*values;
    std::size_t (*count)(const McmlRun& run);
    bool map;  ///< five numbers a line; otherwise one
};

std::size_t cells(int a, int b = 1) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b); }

// In MCML's order.
const Block blocks[] = {
    {"A_l", "absorbed in each layer [-]", &McmlOutput::A_l, [](const McmlRun& r) { return r.layers.size(); }, false},
    {"A_z", "A[0] .. A[nz-1] [1/cm]", &McmlOutput::A_z, [](const McmlRun& r) { return cells(r.nz); }, false},
    {"Rd_r", "Rd[0] .. Rd[nr-1] [1/cm2]", &McmlOutput::Rd_r, [](const McmlRun& r) { return cells(r.nr); }, false},
    {"Rd_a", "Rd[0] .. Rd[na-1] [sr-1]", &McmlOutput::Rd_a, [](const McmlRun& r) { return cells(r.na); }, false},
    {"Tt_r", "Tt[0] .. Tt[nr-1] [1/cm2]", &McmlOutput::Tt_r, [](const McmlRun& r) { return cells(r.nr); }, false},
    {"Tt_a", "Tt[0] .. Tt[na-1] [sr-1]", &McmlOutput::Tt_a, [](const McmlRun& r) { return cells(r.na); }, false},
    {"A_rz", "A[0][0] .. A[0][nz-1], A[1][0] .. [1/cm3]", &McmlOutput::A_rz,
     [](const McmlRun& r) { return cells(r.nr, r.nz); }, true},
    {"Rd_ra", "Rd[0][0] .. Rd[0][na-1], Rd[1][0] .. [1/(cm2sr)]", &McmlOutput::Rd_ra,
     [](const McmlRun& r) { return cells(r.nr, r.na); }, true},
    {"Tt_ra", "Tt[0][0] .. Tt[0][na-1], Tt[1][0] .. [1/(cm2sr)]", &McmlOutput::Tt_ra,
     [](const McmlRun& r) { return cells(r.nr, r.na); }, true},
};

// The line that holds a block's name alone.
void takeName(DataLines& lines, std::string_view name) {
    const std::vector<Word>& line = lines.take(1, fmt::format("the block {}", name));
    if (line[0].text != name)
        throw lines.error(line[0], fmt::format("'{}' in place of the block {}", line[0].text, name));
}

}  // namespace

std::vector<McmlRun> parseMci(std::string_view text, std::string_view path) {
    DataLines lines(text, path);
    const Word version = lines.take(1, "the file version")[0];
    if (version.text == "mcmli2.0") return parseMciVersion2(lines);
    if (version.text != "1.0")
        throw lines.error(version, fmt::format("unknown version '{}'", version.text), "1.0 and mcmli2.0 are read");
    const double count = lines.whole(lines.take(1, "number of runs")[0], "the number of runs", kMostMcmlCells);
    std::vector<McmlRun> runs;
    std::set<std::string> outputs;
    while (runs.size() < static_cast<std::size_t>(count)) {
        const Word first = lines.done() ? Word{} : lines.peek()[0];
        runs.push_back(readRun(lines));
        if (!outputs.insert(runs.back().output).second)
            throw lines.error(first, fmt::format("two runs write {}", runs.back().output));
    }
    if (!lines.done())
        throw lines.error(lines.peek()[0], fmt::format("data after the last of {} runs", runs.size()),
                          "does the number of runs fit?");
    return runs;
}

std::string mciText(std::span<const McmlRun> runs) {
    std::string text = fmt::format("1.0\t\t\t\t# file version; lengths in cm\n{}\t\t\t\t# runs\n\n", runs.size());
    for (const McmlRun& run : runs) text += runText(run);
    return text;
}

std::string mcoText(const McmlOutput& output) {
    // MCML's readers look for names at the start of a line, skip comments before them and in columns, but not in maps.
    std::string text =
        "A1 \t# version of the file format\n\n# The last cells in r, z and angle also hold what lies beyond the "
        "grid.\n\nInParm \t\t\t# input; lengths in cm\n";
    text += runText(output.run);
    text += "RAT\n";
    text += fmt::format("{:<14.6G} \t# specular reflectance [-]\n", output.specular);
    const auto withError = [&](double value, double error, std::string_view what) {
        text += fmt::format("{:<14.6G} \t# {} [-], standard error {:.2g}\n", value, what, error);
    };
    withError(output.Rd, output.Rd_error, "diffuse reflectance");
    withError(output.A, output.A_error, "absorbed fraction");
    withError(output.Tt, output.Tt_error, "transmittance");
    for (const Block& block : blocks) {
        text += block.map ? fmt::format("\n# {}\n{}\n", block.comment, block.name)
                          : fmt::format("\n{} # {}\n", block.name, block.comment);
        const std::vector<double>& values = output.*block.values;
        for (std::size_t i = 0; i < values.size(); ++i)
            text += fmt::format("{:12.4E}{}", values[i], block.map && (i + 1) % 5 != 0 ? ' ' : '\n');
        if (block.map && values.size() % 5 != 0) text += '\n';
    }
    return text;
}

McmlOutput parseMco(std::string_view text, std::string_view path) {
    DataLines lines(text, path);
    const Word version = lines.take(1, "the file version")[0];
    if (version.text != "A1" && version.text != "B1")  // MCML writes B1 as text, too
        throw lines.error(version, fmt::format("unknown version '{}'", version.text), "A1 is read");
    takeName(lines, "InParm");
    McmlOutput output;
    output.run = readRun(lines);
    takeName(lines, "RAT");
    const auto one = [&](std::string_view what) { return lines.number(lines.take(1, what)[0], what); };
    output.specular = one("specular reflectance");
    output.Rd = one("diffuse reflectance");
    output.A = one("absorbed fraction");
    output.Tt = one("transmittance");
    for (const Block& block : blocks) {
        takeName(lines, block.name);
        std::vector<double>& values = output.*block.values;
        const std::size_t count = block.count(output.run);
        const std::string what = fmt::format("the {} values of {}", count, block.name);
        while (values.size() < count)
            for (const Word& word : lines.take(what)) {
                if (values.size() == count) throw lines.error(word, fmt::format("'{}' after {}", word.text, what));
                values.push_back(lines.number(word, fmt::format("a value of {}", block.name)));
            }
    }
    if (!lines.done()) throw lines.error(lines.peek()[0], "data after the block Tt_ra");
    return output;
}

}  // namespace searchlight

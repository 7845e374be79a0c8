// As its authors' mcmlio.c reads them. Unlike there, `end` is the first word of its line, and a medium of that name, or
// one that is given twice, is refused.
#include "transport/mcml/mci_version_2.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <string>

namespace searchlight {

namespace {

using Media = std::map<std::string, McmlLayer, std::less<>>;

bool atEnd(const DataLines& lines) { return !lines.done() && lines.peek()[0].text == "end"; }

// Words after `end` mean nothing.
void takeEnd(DataLines& lines, std::string_view what) {
    const Word word = lines.take(fmt::format("the end of {}", what))[0];
    if (word.text != "end") throw lines.error(word, fmt::format("'{}' in place of the end of {}", word.text, what));
}

Media readMedia(DataLines& lines) {
    Media media;
    while (!atEnd(lines)) {
        const std::vector<Word>& words = lines.take(5, "a medium: name n mua mus g");
        McmlLayer medium;
        medium.n = lines.positive(words[1], "n");
        medium.mua = lines.number(words[2], "mua", 0, 1e15);
        medium.mus = lines.number(words[3], "mus", 0, 1e15);
        medium.g = lines.number(words[4], "g", -1, 1);
        if (!media.emplace(words[0].text, medium).second)
            throw lines.error(words[0], fmt::format("the medium {} is given twice", words[0].text));
    }
    takeEnd(lines, "the media");
    return media;
}

const McmlLayer& mediumOf(const DataLines& lines, const Word& name, const Media& media) {
    const auto found = media.find(name.text);
    if (found != media.end()) return found->second;
    std::string names;
    for (const auto& [known, medium] : media) names += (names.empty() ? "" : ", ") + known;
    throw lines.error(name, fmt::format("unknown medium '{}'", name.text), names);
}

// The media above and below have no thickness.
void readLayers(DataLines& lines, const Media& media, McmlRun& run) {
    run.n_above = mediumOf(lines, lines.take(1, "the medium above")[0], media).n;
    for (;;) {
        const std::vector<Word>& words = lines.take("a layer or the medium below");
        if (words[0].text == "end")
            throw lines.error(words[0], "the layers end without a medium below", "a medium without a thickness");
        const McmlLayer& medium = mediumOf(lines, words[0], media);
        if (words.size() > 2)
            throw lines.error(words[2], fmt::format("'{}' after medium and thickness", words[2].text),
                              "# starts a comment");
        if (words.size() == 1) {
            if (run.layers.empty()) throw lines.error(words[0], "there is no layer between the media above and below");
            run.n_below = medium.n;
            break;
        }
        if (static_cast<double>(run.layers.size()) == kMostMcmlCells)
            throw lines.error(words[0], fmt::format("more than {} layers", kMostMcmlCells));
        run.layers.push_back(medium);
        run.layers.back().d = lines.positive(words[1], "the thickness");
    }
    takeEnd(lines, "the layers");
}

void readSource(DataLines& lines) {
    const Word type = lines.take(1, "the type of the source")[0];
    if (type.text != "pencil")
        throw lines.error(type, fmt::format("the source is '{}'", type.text), "a pencil beam is walked");
    const std::vector<Word>& start = lines.take("the position of the source");
    if (lines.number(start[0], "the position of the source") != 0)
        throw lines.error(start[0], fmt::format("the source is at depth {}", start[0].text), "0 is walked");
    if (start.size() > 1)
        throw lines.error(start[1], fmt::format("'{}' after the position of the source", start[1].text),
                          "a beam from above");
}

std::string lower(std::string_view text) {
    std::string small(text);
    std::ranges::transform(small, small.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return small;
}

// All that a file of version 1 holds is written, whatever is asked for.
void checkCategories(DataLines& lines) {
    constexpr std::array known{"rd_r", "rd_a", "rd_ra", "td_r", "td_a", "td_ra", "a_z", "a_rz"};
    constexpr std::array over_time{"rd_t",  "rd_rt",  "rd_at", "rd_rat", "td_t", "td_rt",
                                   "td_at", "td_rat", "a_t",   "a_zt",   "a_rzt"};
    for (bool more = true; more;) {
        const std::vector<Word>& words = lines.take("what is scored");
        more = false;
        for (const Word& word : words) {
            if (more) throw lines.error(word, fmt::format("'{}' after \\", word.text), "\\ ends a line");
            const std::string name = lower(word.text);
            more = name == "\\";  // goes on in the next line
            if (std::ranges::find(over_time, name) != over_time.end())
                throw lines.error(word, fmt::format("{} is over time", word.text), "walks here know no time");
            if (!more && std::ranges::find(known, name) == known.end())
                throw lines.error(word, fmt::format("unknown category '{}'", word.text),
                                  "Rd_r, Rd_a, Rd_ra, Td_r, Td_a, Td_ra, A_z, A_rz");
        }
    }
}

McmlRun readRun(DataLines& lines, const Media& media) {
    McmlRun run;
    const std::vector<Word>& name = lines.take(2, "output file and format");
    run.output = name[0].text;
    const std::string format = lower(name[1].text);
    if (format != "a" && format != "b")
        throw lines.error(name[1], fmt::format("unknown format '{}'", name[1].text), "A or B");
    run.format = format == "b" ? 'B' : 'A';
    readLayers(lines, media, run);
    readSource(lines);
    const std::vector<Word>& steps = lines.take(3, "dz dr dt");
    run.dz = lines.positive(steps[0], "dz");
    run.dr = lines.positive(steps[1], "dr");
    lines.positive(steps[2], "dt");
    const std::vector<Word>& counts = lines.take(4, "nz nr nt na");
    run.nz = static_cast<int>(lines.whole(counts[0], "nz", kMostMcmlCells));
    run.nr = static_cast<int>(lines.whole(counts[1], "nr", kMostMcmlCells));
    lines.whole(counts[2], "nt", kMostMcmlCells);
    run.na = static_cast<int>(lines.whole(counts[3], "na", kMostMcmlCells));
    checkCategories(lines);
    const std::vector<Word>& control = lines.take("number of photons");
    if (control[0].text.find(':') != std::string_view::npos)
        throw lines.error(control[0], fmt::format("a time limit of {} without a number of photons", control[0].text),
                          "results here depend on that number alone");
    run.photons = static_cast<std::uint64_t>(lines.whole(control[0], "the number of photons", 1e15));
    // hours:minutes may follow: a limit that is not needed here.
    if (control.size() > 2 || (control.size() == 2 && control[1].text.find(':') == std::string_view::npos))
        throw lines.error(control.back(), fmt::format("'{}' after the number of photons", control.back().text),
                          "a time limit is hours:minutes");
    const Word threshold = lines.take(1, "threshold weight")[0];
    if (lines.number(threshold, "the threshold weight", 0, 1) == 1)
        throw lines.error(threshold, "the threshold weight is 1", "below 1");
    lines.number(lines.take(1, "random number seed")[0], "the random number seed", 0, 1e15);
    return run;
}

}  // namespace

std::vector<McmlRun> parseMciVersion2(DataLines& lines) {
    const Media media = readMedia(lines);
    std::vector<McmlRun> runs;
    std::set<std::string> outputs;
    do {
        if (lines.done()) lines.take("the end of all runs");
        const Word first = lines.peek()[0];
        if (static_cast<double>(runs.size()) == kMostMcmlCells)
            throw lines.error(first, fmt::format("more than {} runs", kMostMcmlCells));
        runs.push_back(readRun(lines, media));
        if (!outputs.insert(runs.back().output).second)
            throw lines.error(first, fmt::format("two runs write {}", runs.back().output));
    } while (!atEnd(lines));
    takeEnd(lines, "all runs");
    if (!lines.done()) throw lines.error(lines.peek()[0], "data after the end of all runs");
    return runs;
}

}  // namespace searchlight

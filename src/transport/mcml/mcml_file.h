// The files of MCML version 1, and the input of version 2: .mci in, .mco out ([Wang1995]). Everything here is in the
// units of those files: cm.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace searchlight {

struct McmlLayer {
    double n = 1;    ///< refractive index
    double mua = 0;  ///< absorption, 1/cm
    double mus = 0;  ///< scattering, 1/cm
    double g = 0;    ///< mean cosine
    double d = 0;    ///< thickness, cm; 1e8 stands for a half-space

    bool operator==(const McmlLayer&) const = default;
};

/// One run of an .mci file.
struct McmlRun {
    std::string output;  ///< name of the .mco file
    char format = 'A';   ///< or 'B', which MCML writes as text all the same
    std::uint64_t photons = 0;
    double dz = 0, dr = 0;       ///< of the grid, cm
    int nz = 0, nr = 0, na = 0;  ///< cells in depth, radius and angle (of 90 degrees)
    double n_above = 1, n_below = 1;
    std::vector<McmlLayer> layers;

    bool operator==(const McmlRun&) const = default;
};

/// The numbers of an .mco file. The last cells in radius, depth and angle also hold everything beyond the grid, as MCML
/// has it: never plot them.
struct McmlOutput {
    McmlRun run;
    double specular = 0, Rd = 0, A = 0, Tt = 0;
    /// Standard errors of Rd, A and Tt, which MCML does not know; written as comments, not read.
    double Rd_error = 0, A_error = 0, Tt_error = 0;
    std::vector<double> A_l;           ///< per layer
    std::vector<double> A_z;           ///< nz values, 1/cm
    std::vector<double> Rd_r, Tt_r;    ///< nr values, 1/cm^2
    std::vector<double> Rd_a, Tt_a;    ///< na values, 1/sr
    std::vector<double> A_rz;          ///< nr x nz, 1/cm^3
    std::vector<double> Rd_ra, Tt_ra;  ///< nr x na, 1/(cm^2 sr)
};

/// Reads an .mci file of version 1.0, or of 2.0 (mci_version_2.h says what is refused there). Throws an input Error
/// with file, line and column for anything that MCML itself would read as something else than it says: missing or
/// further values, two runs with one output, data left over.
std::vector<McmlRun> parseMci(std::string_view text, std::string_view path);

/// The text that parseMci reads back as the same runs.
std::string mciText(std::span<const McmlRun> runs);

/// An .mco file of format A1, as MCML's own readers take it.
std::string mcoText(const McmlOutput& output);

/// Reads an .mco file of format A1; its blocks stand in MCML's order. Throws as parseMci.
McmlOutput parseMco(std::string_view text, std::string_view path);

}  // namespace searchlight

// Pictures of a lit body for a paper's plate: its reference, and what the plates share.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "job/paper/lit_body.h"
#include "job/paper/paper.h"
#include "job/paper/picture_sheet.h"
#include "job/plot/subject.h"

namespace searchlight {

/// The material of that name.
Subject subjectNamed(const PaperRun& run, std::string_view material);

/// The object in mm under these lights, seen by the default camera.
Scene sceneOf(std::string object, double scale_mm, std::vector<Light> lights);

/// `size`: of the picture's sides, where the run does not say it.
LitBodyOptions bodyOptions(const PaperRun& run, int size, double cell_pixels);

/// A reference, and two of half its walks: their difference is its error, and says what noise does to an SSIM.
struct ReferencePicture {
    NoisyImage picture;
    std::array<Image, 2> halves;

    double ssimOfHalves(double exposure, int threads) const;
};

struct WalkedBody {
    SphereExitance exitance;
    ReferencePicture reference;
};

/// About so many walks per channel, of which each half has a seed of its own.
WalkedBody walkBodyTwice(const PaperRun& run, const LitBody& body, std::uint64_t walks);

/// By as many walks as the reference: each of them leaves a small part of its flux and not all or nothing, so that the
/// sum is far less noisy.
FirstExitance firstExitance(const PaperRun& run, const LitBody& body, std::uint64_t walks);

NoisyImage noisyImage(const LitBody& body, const SphereExitance& exitance);

/// "12.3 %".
std::string partText(double value);

/// "RMSE 12.3 %, SSIM 0.987", the RMSE without the share of noise.
std::string noteOf(const NoisyError& error);

/// The header of a plate's table of errors, and a row of it.
std::string_view errorCsvHeader();
std::string errorCsvRow(std::string_view material, std::string_view model, std::string_view single,
                        const NoisyError& error);

}  // namespace searchlight

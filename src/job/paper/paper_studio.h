// Pictures that papers show: by any technique, with what they took and how far they are from the truth.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "draw/contact_sheet.h"
#include "job/paper/paper.h"
#include "job/paper/picture_sheet.h"
#include "render/renderer.h"
#include "validate/image_error.h"

namespace searchlight {

struct PaperPicture {
    Image image;
    double exposure = 0;        ///< stops that suit a display
    double prepare_cpu_ms = 0;  ///< of all threads: what comes before the sum over the light, as far as it was stale
    double sum_cpu_ms = 0;      ///< of all threads: that sum
    std::size_t receivers = 0;
    Camera camera;  ///< with the distance that was used
    TechniqueReport report;
};

/// Takes pictures of one scene after another. Each technique has a renderer of its own, whose stages stay.
class PaperStudio {
public:
    /// The object of `run`, which outlives this, its size, and a point light, as the thesis has. `observer` hears of
    /// the work instead of the run's.
    PaperStudio(const PaperRun& run, Observer& observer);

    Scene scene;
    int width = 320, height = 400;  ///< pixels

    PaperPicture take(const std::string& technique, const ParamValues& options = {}, std::uint64_t seed = 1);

    /// take() up to the sum: no image, and no cost of the sum.
    PaperPicture prepare(const std::string& technique, const ParamValues& options = {}, std::uint64_t seed = 1);

    /// What pictures are judged by: the light of 200,000 points, summed to 0.1 %.
    PaperPicture truth();

    /// What the last picture by that technique was made from. Requires one; valid until the next.
    RenderStages stages(const std::string& technique) const;

private:
    const PaperRun& run_;
    Observer& observer_;
    std::map<std::string, std::unique_ptr<Renderer>> renderers_;
};

/// The relative RMSE (docs/images.md) of one picture.
double errorOf(const PaperPicture& picture, const PaperPicture& truth);

/// Where `errors` over `x`, both above 0, falls to `wanted`: between neighbours, and beyond the ends along the line
/// through the two nearest, both on logarithmic scales. Requires two values, x ascending.
double whereItFallsTo(double wanted, const std::vector<double>& x, const std::vector<double>& errors);

/// A picture for a sheet, before a dark ground.
SheetCell shownCell(const Image& image, double exposure, std::string note = {});

/// Where points and atlases of a user's pictures are kept; nothing where there is no home.
std::optional<CacheFolder> shapeCache();

/// "statue, 320 x 400 pixels, one point light": what stands in for the paper's own.
std::string studioText(const PaperRun& run);

/// "2.7 %"
std::string percentOf(double fraction);

/// A sheet for pictures of that size.
ContactSheet paperSheet(const PaperStudio& studio, std::string title, std::string caption);

}  // namespace searchlight

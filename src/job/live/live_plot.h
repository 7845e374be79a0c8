// The searchlight plot of a window: the same figures as the plot commands, drawn again at each move of a slider.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/figure.h"
#include "base/observer.h"
#include "job/engine.h"
#include "plot/channel.h"
#include "scene/scene.h"

namespace searchlight {

/// A model of the plot, and the colour that it keeps (draw/palette.h).
struct LiveModel {
    SceneModel model;
    std::optional<SceneMaterial> material;  ///< its own, inverted by itself; none: the request's
    int color = 0;
};

struct LiveRequest {
    enum class View {
        profile,  ///< R_d over r
        error,    ///< relative, against the reference
        plane,    ///< R_d on both sides of the beam, in the plane of incidence
        slice     ///< R_d over the surface, in false colour
    };

    View view = View::profile;
    std::vector<LiveModel> models;  ///< those to be seen
    int solo = -1;                  ///< index into models: alone, channel by channel
    SceneMaterial material;         ///< the reference's, and of models that have none of their own
    SceneModel inverted_by;         ///< what inverts that, where it is Rdr and ld
    PlotChannel channel = PlotChannel::red;
    AxisScale x_scale = AxisScale::linear, y_scale = AxisScale::logarithmic;
    int radius_power = 0;
    double angle_deg = 0;
    double radii_max_mm = 0;  ///< 0: chosen from the medium
    int bins = 64;
    double walks = 1e6;  ///< of the reference, per channel; 0: none
    std::uint64_t seed = 1;
};

/// Why a model is not in the figure.
struct LiveProblem {
    std::size_t model = 0;  ///< index into the request's
    Error error;
};

struct LivePlotResult {
    Figure figure;  ///< without series and panels when there is nothing to show
    std::vector<LiveProblem> problems;
    std::string reference;                  ///< its label; empty: none yet
    std::string reference_note;             ///< why there is none, or what it is not
    double reference_walks = 0;             ///< per channel; 0: none yet
    double model_ms = 0, reference_ms = 0;  ///< wall time
};

/// How closely curves are sampled.
enum class LiveDetail { coarse, fine };

/// Keeps compiled models, and white tables (transport/white) of the last few (g, eta, angle): a move of sigma_a or
/// sigma_s walks nothing. One thread at a time.
class LivePlot {
public:
    explicit LivePlot(Engine& engine);
    ~LivePlot();

    /// With the reference that is known so far: makes none. Errors of models are in the result; throws an input Error
    /// for a request that makes no sense, and those of materials.
    LivePlotResult draw(const LiveRequest& request, LiveDetail detail);

    /// Whether draw() of a fine figure takes long enough for a coarse one to come first.
    bool isSlow(const LiveRequest& request);

    /// Makes a better reference: first of 1e5 walks, then of all. False: there is none better. Throws
    /// interruptedError() when cancelled.
    bool improve(const LiveRequest& request, Observer& observer);

    /// Forgets what was compiled: the context is gone, or a file has changed.
    void forgetModels();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace searchlight

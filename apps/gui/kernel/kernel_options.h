// What the kernel dock shows: a section of the workspace.
#pragma once

#include <QString>
#include <optional>
#include <string>
#include <vector>

#include "gui/state/state.h"
#include "kernel/methods.h"

namespace searchlight::gui {

/// View, method, channel, signal, taps, ground truth, and the two Gaussians that are set by hand.
std::vector<Param> kernelOptions();

/// One of each method and rank, as `searchlight kernel --all` has them: the rows of the table.
struct NamedMethod {
    std::string name;  ///< MadeKernel's
    MethodOptions options;
};
std::vector<NamedMethod> namedMethods(int taps);

/// All that kernels depend on.
struct KernelWish {
    SceneMaterial material;  ///< the active slot's, or the scene's
    SceneModel model;        ///< the active one
    bool of_model = false;   ///< the model is the ground truth, instead of walks
    std::uint64_t seed = 1;
    int taps = 17;
    std::optional<TwoGaussians> manual;  ///< none: fitted
    std::string method;                  ///< the name of the row that is looked at
    std::string view;
    int channel = 0;
    std::size_t signal = 0;  ///< its place in signals()

    /// Equal for wishes that have one ground truth, as long as the model's file stays the same.
    std::string truthKey() const;
    /// What one row depends on beside the truth.
    std::string rowKey(const std::string& row) const;
};

KernelWish kernelWish(const State& state);

/// Puts numbers into the sliders' options, as one that was set by hand.
void setManual(State& state, const TwoGaussians& values);

/// The `kernel` command that makes the same. Empty for two Gaussians set by hand: the command fits them.
QString kernelCommandLine(const State& state);

}  // namespace searchlight::gui

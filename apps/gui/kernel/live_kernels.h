// Kernels of the window: the truth, what was made of it so far, and what is shown of one kernel.
#pragma once

#include <QImage>
#include <map>
#include <memory>
#include <string>

#include "base/figure.h"
#include "gui/kernel/kernel_options.h"
#include "job/kernel/kernel_judged.h"
#include "job/kernel/kernel_truth.h"

namespace searchlight::gui {

/// What all kernels of a material are judged against.
struct KernelBase {
    Subject subject;
    KernelTruth truth;
    Judge judge;
    TwoGaussians fitted;  ///< where the sliders stand until they are moved
};

/// Pictures of one signal; the difference is that of `filtered` from `exact`.
struct KernelPictures {
    QImage before, exact, filtered, difference;
    double rms = 0;  ///< absolute, light in [0, 1]
};

/// What the dock shows of one kernel.
struct KernelShown {
    std::shared_ptr<const KernelBase> base;
    std::shared_ptr<const JudgedKernel> judged;
    Figure figure;            ///< of the views "curves" and "edge"; without panels for others
    KernelPictures pictures;  ///< of the view "pictures"
};

/// The colour scale of KernelPictures::difference ends at this part of the exact picture's mean.
inline constexpr double kKernelDifferenceScale = 0.2;

/// Lives on a lane's thread, with its engine. Keeps the last truth and all kernels that were made of it.
class LiveKernels {
public:
    explicit LiveKernels(Engine& engine) : engine_(engine) {}

    /// Makes the truth, or a better one: first of 1e5 walks, then of 1e6; a model has one step. False: there is none
    /// better. Throws Error, and interruptedError() when cancelled.
    bool improveTruth(const KernelWish& wish, Observer& observer);

    /// Whether there is a truth of this wish, be it the first one.
    bool hasTruth(const KernelWish& wish) const { return base_ && keyOf(wish) == key_; }

    /// Needs a truth of this wish.
    KernelShown show(const KernelWish& wish);

    /// One row of the table; `perceptual`: with FLIP and SSIM.
    std::shared_ptr<const JudgedKernel> row(const KernelWish& wish, const NamedMethod& method, bool perceptual);

private:
    struct Row {
        std::shared_ptr<const JudgedKernel> judged;
        bool perceptual = false;
    };

    static std::string keyOf(const KernelWish& wish);

    Engine& engine_;
    std::string key_;
    std::uint64_t walks_ = 0;  ///< of base_
    std::shared_ptr<const KernelBase> base_;
    std::map<std::string, Row> rows_;
};

}  // namespace searchlight::gui

// Texture space sampling on a device: cells by a mip chain, and the sum over samples, receiver by receiver.
#pragma once

#include <span>
#include <vector>

#include "model/profile.h"
#include "render/sum_gl.h"
#include "render/texture/cell_choice.h"
#include "scene/point_cloud.h"

namespace searchlight {

class TextureGl {
public:
    /// Compiles the passes. The context outlives this.
    explicit TextureGl(gl::Context& context);

    /// What CellChooser chooses, but for rounding to float: sums of four by four up to one, and down again for each of
    /// `along` [Chang2007, Alg. 3.1, but that a dark cell is never taken]. Weights from 0 on, not all 0.
    std::vector<CellChoice> choose(std::span<const double> weights, std::span<const double> along);

    void setSamples(const PointCloud& points, std::span<const Rgbf> transmitted);    ///< flux per mm^2 of their areas
    void setProfile(const Profile& profile, double cell_area_mm2, double area_mm2);  ///< as RadialTable has it
    void setReceivers(std::span<const Vec3f> receivers);

    /// Exitance of receivers [first, first + exitance.size()). Waits.
    void sum(std::size_t first, std::span<Rgbf> exitance);

private:
    gl::Context& context_;
    gl::Program pyramid_, choose_, sum_;
    gl::Buffer sums_, along_, choices_, receivers_, exitance_;
    TableGl radial_, samples_;
    int sample_count_ = 0, table_entries_ = 0, table_first_bits_ = 0;
    double table_offset_ = 1;
};

}  // namespace searchlight

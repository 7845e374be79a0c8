#include "render/tsm.h"

#include "render/light_view/light_view_sum.h"

namespace searchlight {

namespace {

class Tsm final : public Technique {
public:
    void start(const RenderInput& input, const ParamValues& options, Observer& observer) override {
        const auto whole = [&](const char* name) { return static_cast<int>(std::get<double>(options.at(name))); };
        exitance_.assign(input.visible->positions.size(), {});
        sum_.start(input, *input.profile, input.versions.material, whole("local_samples"), whole("light_map"),
                   observer);
    }

    bool step(Observer& observer) override { return exitance_.empty() || sum_.step(exitance_, observer); }

    std::span<const Rgbf> exitance() const override { return exitance_; }

    TechniqueReport report() const override {
        TechniqueReport report{
            .approximates = "what a light sees is a patch of a plane per texel of its map, read at few places",
            .device = "cpu"};
        sum_.addTo(report);
        return report;
    }

private:
    LightViewSum sum_;
    std::vector<Rgbf> exitance_;
};

}  // namespace

std::vector<Param> lightViewOptions() {
    return {{.name = "local_samples",
             .type = ParamType::integer,
             .min = 1,
             .max = 1e6,
             .value = 401.0,
             .doc = "of the surroundings of each sample of the picture: L rings of C and one in the middle"},
            {.name = "light_map",
             .type = ParamType::integer,
             .min = 16,
             .max = 2048,
             .value = 512.0,
             .doc = "texels along the longer side of what a light sees"}};
}

std::unique_ptr<Technique> makeTsm(gl::Context*) { return std::make_unique<Tsm>(); }

}  // namespace searchlight

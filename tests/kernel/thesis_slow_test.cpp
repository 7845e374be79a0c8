#include <gtest/gtest.h>

#include <string>

#include "held_out.h"

namespace searchlight {
namespace {

class ThesisMaterials : public testing::TestWithParam<std::string_view> {};

TEST_P(ThesisMaterials, TheBestKernelsHereErrLessOnPicturesThatNobodyHadSeen) {
    int count = 0, each = 0;
    double worst[2] = {}, overall[2] = {};
    for (const Material& material : materials()) {
        bool scatters = false;
        for (int c = 0; c < material.medium.channels; ++c) scatters = scatters || material.medium.scatters(c);
        if (!scatters) continue;
        const GroundTruth truth = test::truthOf(material.medium, GetParam());
        const test::HeldOut pictures(truth);
        bool here = true;
        for (const int passes : {2, 4}) {
            const test::Ratios found = test::ratios(pictures, passes);
            std::printf("%s %s %d worst %.3f overall %.3f\n", std::string(GetParam()).c_str(), material.id.c_str(),
                        passes, found.worst, found.overall);
            here = here && found.worst < 1;
            worst[passes / 4] = std::max(worst[passes / 4], found.worst);
            overall[passes / 4] = std::max(overall[passes / 4], found.overall);
        }
        ++count;
        each += here;
    }
    std::printf("count %d each %d worst %f %f overall %f %f\n", count, each, worst[0], worst[1], overall[0],
                overall[1]);
}

INSTANTIATE_TEST_SUITE_P(Truths, ThesisMaterials, testing::Values("normalized_diffusion", "better_dipole"));

}  // namespace
}  // namespace searchlight

// What reference sphere and reference mesh share: the scene around a closed body, and the two things that are walked of
// it.
#pragma once

#include <string_view>

#include "geometry/object.h"
#include "job/command.h"
#include "job/plot/subject.h"
#include "light/light_sampler.h"
#include "render/view.h"
#include "transport/mesh/reference_body.h"

namespace searchlight {

struct BodySetup {
    Subject subject;
    Object object;
    View view;
    LightSampler lights;
    BodyOptions walk;
    double cell_area_mm2 = 0;
};

/// Walks the exitance that light leaves on the cells of a body, and writes the job's picture of it. `geometry` is what
/// the documents call the body.
JobResult exitanceOf(const Job& job, const BodySetup& setup, const Ball& body, std::string_view geometry,
                     Observer& observer);
JobResult exitanceOf(const Job& job, const BodySetup& setup, const MeshBody& body, std::string_view geometry,
                     Observer& observer);

/// The same of the radiance that the camera sees.
JobResult radianceOf(const Job& job, const BodySetup& setup, const Ball& body, std::string_view geometry,
                     Observer& observer);
JobResult radianceOf(const Job& job, const BodySetup& setup, const MeshBody& body, std::string_view geometry,
                     Observer& observer);

}  // namespace searchlight

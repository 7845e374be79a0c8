// The rows of commands.cpp, each made in the command's own file.
#pragma once

#include "job/command.h"

namespace searchlight {

Command modelsCommand();
Command materialsCommand();
Command profileCommand();
Command invertCommand();
Command convertCommand();
Command fitCommand();
Command kernelCommand();
Command referenceHalfSpaceCommand();
Command referenceSlabCommand();
Command referenceSphereCommand();
Command referenceMeshCommand();
Command mcmlCommand();
Command renderCommand();
Command spheresCommand();
Command contestCommand();
Command sweepCommand();
Command meshCommand();
Command pointsCommand();
Command plotPencilCommand();
Command plotErrorCommand();
Command plotAlbedoCommand();
Command plotObliqueCommand();
Command plotSliceCommand();
Command plotMomentsCommand();
Command plotHemisphereCommand();
Command paperCommand();
Command compareCommand();
Command rankCommand();
Command checkCommand();
Command reportCommand();
Command benchTransportCommand();
Command benchRenderCommand();
Command doctorCommand();

}  // namespace searchlight

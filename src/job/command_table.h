// The rows of commands.cpp, each made in the command's own file.
#pragma once

#include "job/command.h"

namespace searchlight {

Command modelsCommand();
Command materialsCommand();
Command profileCommand();
Command invertCommand();
Command referenceHalfSpaceCommand();
Command referenceSlabCommand();
Command mcmlCommand();
Command plotPencilCommand();
Command plotErrorCommand();
Command plotAlbedoCommand();
Command checkCommand();
Command reportCommand();
Command doctorCommand();

}  // namespace searchlight

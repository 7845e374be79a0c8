#include "base/error.h"
#include "base/text.h"
#include "job/command_table.h"

namespace searchlight {

std::span<const Command> commands() {
    static const std::vector<Command> table{
        modelsCommand(),  // one to a line
        materialsCommand(),
        profileCommand(),
        invertCommand(),
        convertCommand(),
        fitCommand(),
        kernelCommand(),
        referenceHalfSpaceCommand(),
        referenceSlabCommand(),
        referenceSphereCommand(),
        referenceMeshCommand(),
        mcmlCommand(),
        renderCommand(),
        spheresCommand(),
        contestCommand(),
        sweepCommand(),
        meshCommand(),
        pointsCommand(),
        plotPencilCommand(),
        plotErrorCommand(),
        plotAlbedoCommand(),
        plotObliqueCommand(),
        plotSliceCommand(),
        plotMomentsCommand(),
        plotHemisphereCommand(),
        paperCommand(),
        compareCommand(),
        rankCommand(),
        checkCommand(),
        reportCommand(),
        benchTransportCommand(),
        benchRenderCommand(),
        doctorCommand(),
    };
    return table;
}

const Command& findCommand(std::string_view name) {
    std::vector<std::string> names;
    for (const Command& command : commands()) {
        if (command.name == name) return command;
        names.emplace_back(command.name);
    }
    throw unknownName(ErrorKind::usage, "command", name, names);
}

std::vector<std::string> Options::names(std::string_view name) const {
    std::vector<std::string> parts;
    if (text(name).empty()) return parts;
    for (const std::string_view part : split(text(name), ',')) parts.emplace_back(trim(part));
    return parts;
}

const ParamValue& Options::value(std::string_view name) const {
    return valueOf(findParam(command_.options, name, "option"), job_.options);
}

}  // namespace searchlight

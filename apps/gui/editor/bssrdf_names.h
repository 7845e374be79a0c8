// The words that a model's text may use: what the editor colours and completes.
#pragma once

#include <QString>
#include <QStringList>

namespace searchlight::gui {

struct BssrdfNames {
    QStringList types, keywords, builtins;
    QStringList physics;     ///< functions of physics/
    QStringList globals;     ///< SigmaA, Xi...
    QStringList attributes;  ///< of the first line
    QStringList sections;    ///< after ::begin and ::end

    /// All of them, sorted.
    QStringList all() const;
};

const BssrdfNames& bssrdfNames();

/// "vec3 fresnelTransmittance(...)" of a physics function, with the comment before it; empty for other names.
QString physicsHelp(const QString& name);

}  // namespace searchlight::gui

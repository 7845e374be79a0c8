#include "gui/models/model_files.h"

#include <QCoreApplication>
#include <QDir>
#include <QFile>
#include <QFileInfo>
#include <QRegularExpression>
#include <QStandardPaths>

#include "base/embedded.h"
#include "base/error.h"
#include "base/files.h"
#include "model/model.h"

namespace searchlight::gui {

namespace {

QString shippedText(const std::string& id) {
    for (const EmbeddedFile& file : embeddedFiles())
        if (file.path == "models/" + id + ".bssrdf")
            return QString::fromUtf8(file.text.data(), static_cast<qsizetype>(file.text.size()));
    return {};
}

constexpr const char* kRadial = R"(analytic radial no_wi no_wo reciprocal

::begin info
title     Exponential
citation  yours
validity  to be found out: run the checks
::end info

::begin parameters
float Reach 0.1 2 0.5  # decay length, in diffuse mean free paths
::end parameters

::begin initializer
vec3 Decay;  // 1/mm
vec3 Total;  // of what entered, how much leaves

void init() {
    vec3 SigmaSp = (1.0 - G) * SigmaS;
    vec3 SigmaTp = SigmaA + SigmaSp;
    Decay = sqrt(3.0 * SigmaA * SigmaTp) / Reach;
    Total = 0.5 * SigmaSp / SigmaTp;
}
::end initializer

::begin shader
// R_d, 1/mm^2: its integral over the plane is Total.
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    float R = distance(Xi, Xo);
    return Total * Decay * exp(-Decay * R) / (2.0 * PI * R);
}
::end shader
)";

constexpr const char* kDirectional = R"(analytic no_wo

::begin info
title     Shifted Gaussian
citation  yours
validity  to be found out: run the checks
note      The refracted beam moves the middle of the light by a part of the mean free path.
::end info

::begin parameters
float Shift 0 2 0.6  # along the refracted beam, in transport mean free paths
::end parameters

::begin initializer
vec3 Mfp, Width, Total;  // mm, mm, of what entered

void init() {
    vec3 SigmaSp = (1.0 - G) * SigmaS;
    vec3 SigmaTp = SigmaA + SigmaSp;
    Mfp = 1.0 / SigmaTp;
    Width = inversesqrt(3.0 * SigmaA * SigmaTp);
    Total = 0.5 * SigmaSp / SigmaTp;
}
::end initializer

::begin shader
vec3 Bssrdf(vec3 Xi, vec3 Wi, vec3 Xo, vec3 Wo) {
    // Sideways part of the refracted beam, which goes on as -Wi / IOR.
    vec2 Along = -Wi.xy / IOR;
    vec3 Dx = vec3(Xo.x - Xi.x) - Shift * Mfp * Along.x;
    vec3 Dy = vec3(Xo.y - Xi.y) - Shift * Mfp * Along.y;
    vec3 Dz = vec3(Xo.z - Xi.z);
    vec3 Variance = Width * Width;
    return Total * exp(-0.5 * (Dx * Dx + Dy * Dy + Dz * Dz) / Variance) / (2.0 * PI * Variance);
}
::end shader
)";

}  // namespace

ModelText modelText(const std::string& id) {
    ModelText found;
    if (const QString text = shippedText(id); !text.isEmpty()) {
        found.text = text;
        return found;
    }
    found.path = QString::fromStdString(id);
    if (!found.path.endsWith(QLatin1String(".bssrdf"))) {
        found.why_not = id.find('+') != std::string::npos
                            ? QCoreApplication::translate("ModelFiles", "A sum of models has no text of its own.")
                            : QCoreApplication::translate("ModelFiles", "A measured profile is a table of numbers.");
        return found;
    }
    found.text = QString::fromStdString(readFile(id));
    found.writable = QFileInfo(found.path).isWritable();
    return found;
}

QString modelTitle(const std::string& id) {
    try {
        return QString::fromStdString(loadModel(id).file.title);
    } catch (const Error&) {
        return QString::fromStdString(id).section(QLatin1Char('/'), -1);
    }
}

QString modelsFolder() {
    const QString wish = qEnvironmentVariable("SEARCHLIGHT_MODELS");
    const QString folder = wish.isEmpty() ? QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation) +
                                                QStringLiteral("/searchlight/models")
                                          : wish;
    QDir().mkpath(folder);
    return folder;
}

QString freeModelPath(const QString& stem) {
    const QDir folder(modelsFolder());
    QString name = stem + QStringLiteral(".bssrdf");
    for (int i = 2; folder.exists(name); ++i) name = QStringLiteral("%1_%2.bssrdf").arg(stem).arg(i);
    return folder.filePath(name);
}

QList<ModelTemplate> modelTemplates() {
    QList<ModelTemplate> list{
        {QStringLiteral("radial"), QCoreApplication::translate("ModelFiles", "Radial: an exponential")},
        {QStringLiteral("directional"), QCoreApplication::translate("ModelFiles", "Directional: a shifted Gaussian")}};
    for (const Model& model : shippedModels())
        list.append({QString::fromStdString(model.id), QString::fromStdString(model.file.title)});
    return list;
}

QString newModelText(const QString& id, const QString& title) {
    QString text = id == QLatin1String("radial")        ? QString::fromUtf8(kRadial)
                   : id == QLatin1String("directional") ? QString::fromUtf8(kDirectional)
                                                        : shippedText(id.toStdString());
    if (text.isEmpty()) throw inputError("there is no template '" + id.toStdString() + "'");
    if (!title.isEmpty())
        text.replace(QRegularExpression(QStringLiteral("^title .*$"), QRegularExpression::MultilineOption),
                     QStringLiteral("title     ") + title);
    return text;
}

}  // namespace searchlight::gui

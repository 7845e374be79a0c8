#include "gui/editor/bssrdf_names.h"

#include <QMap>
#include <QRegularExpression>
#include <algorithm>

#include "base/embedded.h"
#include "language/glsl_names.h"

namespace searchlight::gui {

namespace {

// Signature and comment by name, of every function that physics/ gives to models.
const QMap<QString, QString>& physicsFunctions() {
    static const QMap<QString, QString> functions = [] {
        QMap<QString, QString> found;
        const QRegularExpression function(
            QStringLiteral("((?:^//[^\\n]*\\n)*)^((?:float|int|bool|vec[234]|mat[234])\\s+(\\w+)\\([^)]*\\))"),
            QRegularExpression::MultilineOption);
        for (const EmbeddedFile& file : embeddedFiles()) {
            if (!file.path.starts_with("physics/")) continue;
            auto match =
                function.globalMatch(QString::fromUtf8(file.text.data(), static_cast<qsizetype>(file.text.size())));
            while (match.hasNext()) {
                const QRegularExpressionMatch each = match.next();
                QString comment = each.captured(1);
                comment.remove(QStringLiteral("// ")).replace(QLatin1Char('\n'), QLatin1Char(' '));
                found[each.captured(3)] = each.captured(2).simplified() + QLatin1Char('\n') + comment.simplified();
            }
        }
        return found;
    }();
    return functions;
}

}  // namespace

QStringList BssrdfNames::all() const {
    QStringList names = types + keywords + builtins + physics + globals + sections;
    names.sort(Qt::CaseInsensitive);
    names.removeDuplicates();
    return names;
}

const BssrdfNames& bssrdfNames() {
    static const BssrdfNames names = [] {
        BssrdfNames made;
        made.types = {QStringLiteral("void"),  QStringLiteral("bool"),  QStringLiteral("int"),
                      QStringLiteral("float"), QStringLiteral("vec2"),  QStringLiteral("vec3"),
                      QStringLiteral("vec4"),  QStringLiteral("mat2"),  QStringLiteral("mat3"),
                      QStringLiteral("mat4"),  QStringLiteral("color"), QStringLiteral("choice")};
        made.keywords = {QStringLiteral("const"),  QStringLiteral("if"),    QStringLiteral("else"),
                         QStringLiteral("for"),    QStringLiteral("while"), QStringLiteral("do"),
                         QStringLiteral("return"), QStringLiteral("break"), QStringLiteral("continue"),
                         QStringLiteral("in"),     QStringLiteral("out"),   QStringLiteral("inout"),
                         QStringLiteral("true"),   QStringLiteral("false"), QStringLiteral("struct")};
        for (const std::string& name : portableBuiltins()) made.builtins << QString::fromStdString(name);
        made.physics = physicsFunctions().keys();
        made.globals = {QStringLiteral("SigmaA"), QStringLiteral("SigmaS"), QStringLiteral("G"),
                        QStringLiteral("IOR"),    QStringLiteral("PI"),     QStringLiteral("Ni"),
                        QStringLiteral("No"),     QStringLiteral("Xi"),     QStringLiteral("Wi"),
                        QStringLiteral("Xo"),     QStringLiteral("Wo"),     QStringLiteral("AlphaPrime")};
        made.attributes = {
            QStringLiteral("analytic"),   QStringLiteral("radial"),           QStringLiteral("no_wi"),
            QStringLiteral("no_wo"),      QStringLiteral("normals"),          QStringLiteral("single_scattering"),
            QStringLiteral("reciprocal"), QStringLiteral("energy_violation"), QStringLiteral("grosjean")};
        made.sections = {QStringLiteral("info"), QStringLiteral("parameters"), QStringLiteral("initializer"),
                         QStringLiteral("diffuseReflectance"), QStringLiteral("shader")};
        return made;
    }();
    return names;
}

QString physicsHelp(const QString& name) { return physicsFunctions().value(name); }

}  // namespace searchlight::gui

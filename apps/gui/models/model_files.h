// Texts of models: where they are, and new ones.
#pragma once

#include <QString>
#include <QStringList>

namespace searchlight::gui {

/// A model's text, and whether it may be edited.
struct ModelText {
    QString text;
    QString path;           ///< empty: inside the program
    bool writable = false;  ///< a file of the user's
    QString why_not;        ///< why there is no text to edit; empty: there is one
};

/// Of a model's id: shipped, or a path. Throws an input Error for a file that cannot be read.
ModelText modelText(const std::string& id);

/// Its title; for a file that cannot be read, its name.
QString modelTitle(const std::string& id);

/// Where new models go: DATA/searchlight/models, made when needed; $SEARCHLIGHT_MODELS in its place.
QString modelsFolder();

/// A name in modelsFolder() that no file has: "my_model.bssrdf", "my_model_2.bssrdf".
QString freeModelPath(const QString& stem);

/// What a new model may begin as: id of the template and its title.
struct ModelTemplate {
    QString id, title;
};
QList<ModelTemplate> modelTemplates();

/// The text of a template, or of a shipped model, with that title. Throws an input Error for another id.
QString newModelText(const QString& id, const QString& title);

}  // namespace searchlight::gui

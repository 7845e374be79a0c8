// The one place where the state changes: undo and redo, files, and the signal that everything else follows.
#pragma once

#include <QObject>
#include <QString>
#include <QUndoStack>
#include <functional>
#include <memory>

#include "gui/state/state.h"

namespace searchlight::gui {

/// Lives on the window's thread.
class Workspace : public QObject {
    Q_OBJECT

public:
    explicit Workspace(QObject* parent = nullptr);

    const State& state() const { return *state_; }
    /// The same value, for another thread to keep: it never changes.
    std::shared_ptr<const State> snapshot() const { return state_; }

    /// Edits a copy and makes it the state: one step of undo, called `text` ("Absorption"). Steps of one non-empty
    /// `gesture` ("material.sigma_a") that follow each other become one, until endGesture(). An edit that changes
    /// nothing is none.
    void edit(const QString& text, const QString& gesture, const std::function<void(State&)>& change);

    /// The mouse was released, the field left: the next edit is a step of its own.
    void endGesture();

    /// An option of a section (sections.cpp), as an edit.
    void setOption(const QString& text, std::string_view section, std::string_view name, ParamValue value);

    /// A camera that moves by itself leaves no steps of undo.
    void moveCamera(const Camera& camera);

    /// Starts anew: no undo beyond it. `path` is the file that it came from; empty: none yet.
    void open(State state, const QString& path);

    /// Writes the workspace file. Throws an input Error.
    void save(const QString& path);

    /// The file of a model was written: whoever loaded it loads it again. `id` as in SceneModel.
    void noteModelFile(const QString& id) { emit modelFileChanged(id); }

    QUndoStack& undoStack() { return undo_; }
    const QString& path() const { return path_; }
    bool isModified() const { return !undo_.isClean(); }

Q_SIGNALS:
    /// state() is another one. `change`: what differs.
    void changed(searchlight::gui::Change change);
    void modelFileChanged(const QString& id);
    /// Another file, or saved, or changed since.
    void fileChanged();

private:
    class Step;
    void set(std::shared_ptr<const State> state);

    std::shared_ptr<const State> state_;
    QUndoStack undo_;
    QString path_;
    int gesture_count_ = 0;
};

}  // namespace searchlight::gui

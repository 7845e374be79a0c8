#include "gui/state/workspace.h"

#include <utility>

#include "base/files.h"

namespace searchlight::gui {

/// A step of undo holds both states whole: they share nothing that changes, and one is a few kilobytes.
class Workspace::Step : public QUndoCommand {
public:
    Step(Workspace& workspace, const QString& text, QString gesture, std::shared_ptr<const State> after)
        : QUndoCommand(text),
          workspace_(workspace),
          gesture_(std::move(gesture)),
          before_(workspace.state_),
          after_(std::move(after)) {}

    void undo() override { workspace_.set(before_); }
    void redo() override { workspace_.set(after_); }
    int id() const override { return gesture_.isEmpty() ? -1 : 1; }
    bool mergeWith(const QUndoCommand* next) override {
        const auto& step = static_cast<const Step&>(*next);
        if (step.gesture_ != gesture_) return false;
        after_ = step.after_;
        return true;
    }

private:
    Workspace& workspace_;
    QString gesture_;
    std::shared_ptr<const State> before_, after_;
};

Workspace::Workspace(QObject* parent) : QObject(parent), state_(std::make_shared<const State>(defaultState())) {
    undo_.setUndoLimit(1000);
    connect(&undo_, &QUndoStack::cleanChanged, this, &Workspace::fileChanged);
}

void Workspace::edit(const QString& text, const QString& gesture, const std::function<void(State&)>& change) {
    auto after = std::make_shared<State>(*state_);
    change(*after);
    normalise(*after);
    if (difference(*state_, *after).empty()) return;
    const QString key = gesture.isEmpty() ? gesture : QStringLiteral("%1 %2").arg(gesture).arg(gesture_count_);
    undo_.push(new Step(*this, text, key, std::move(after)));
}

void Workspace::endGesture() { ++gesture_count_; }

void Workspace::setOption(const QString& text, std::string_view section, std::string_view name, ParamValue value) {
    const QString gesture = QString::fromStdString(std::string(section) + "." + std::string(name));
    edit(text, gesture,
         [&](State& state) { state.options[std::string(section)][std::string(name)] = std::move(value); });
}

void Workspace::moveCamera(const Camera& camera) {
    auto after = std::make_shared<State>(*state_);
    after->scene.camera = camera;
    set(std::move(after));
}

void Workspace::open(State state, const QString& path) {
    normalise(state);
    undo_.clear();
    path_ = path;
    state_ = std::make_shared<const State>(std::move(state));
    emit changed(Change::all());
    emit fileChanged();
}

void Workspace::save(const QString& path) {
    writeFile(path.toStdString(), workspaceJson(*state_));
    path_ = path;
    undo_.setClean();
    emit fileChanged();
}

void Workspace::set(std::shared_ptr<const State> state) {
    const Change change = difference(*state_, *state);
    state_ = std::move(state);
    if (!change.empty()) emit changed(change);
}

}  // namespace searchlight::gui

// Work beside the window: each lane is a thread with an engine, and so an OpenGL context, of its own. In a lane tasks
// run one after another, and of one key the newest wins.
#pragma once

#include <QObject>
#include <QPointer>
#include <QString>
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/observer.h"
#include "job/engine.h"

namespace searchlight::gui {

/// What a task works with, on its lane's thread.
class TaskContext : public Observer {
public:
    /// The lane's own; it stays from task to task.
    virtual Engine& engine() = 0;

    /// Runs `deliver` on the window's thread, unless the task was superseded or cancelled, or its receiver is gone, by
    /// then. What it captures is the result: nothing that the task goes on changing.
    virtual void publish(std::function<void()> deliver) = 0;
};

struct TaskSpec {
    std::string lane;  ///< "picture", "curves": a thread, made when first used
    /// A task supersedes those of its key in its lane: one that waits is dropped, one that runs is cancelled.
    std::string key;
    QString title;                ///< shown with a bar once it takes longer than a moment; empty: never shown
    bool background = false;      ///< begins only while no picture is being made: see Tasks::holdBackground()
    QObject* receiver = nullptr;  ///< of what is published; when it dies, the task is cancelled
};

/// What the status bar shows of one task.
struct TaskStatus {
    std::uint64_t id = 0;
    QString title;
    double fraction = -1;      ///< of the work; below 0: unknown
    double seconds = 0;        ///< since it began
    double seconds_left = -1;  ///< below 0: unknown
};

/// Lives on the window's thread, which it never blocks but in its destructor.
class Tasks : public QObject {
    Q_OBJECT

public:
    explicit Tasks(QObject* parent = nullptr);
    /// Cancels everything and waits.
    ~Tasks() override;

    /// Returns an id for cancel(). `work` runs on the lane's thread and publishes what it finds. It may throw Error:
    /// `failed` then runs on the window's thread, but not for interruptedError().
    std::uint64_t start(TaskSpec spec, std::function<void(TaskContext&)> work,
                        std::function<void(const Error&)> failed = {});

    void cancel(std::uint64_t id);
    /// What the lane has of that key.
    void cancel(const std::string& lane, const std::string& key);
    /// Something runs or waits.
    bool busy() const;

    /// Titled tasks that run, oldest first.
    std::vector<TaskStatus> status() const;

    /// While held, no background task begins; those that run go on. Whoever makes what a person waits for holds.
    void holdBackground(bool hold) { hold_background_ = hold; }

    /// Called on the lane's thread before it ends, so that what a lane keeps on its engine goes before the engine.
    void atLaneEnd(const std::string& lane, std::function<void()> clean);

Q_SIGNALS:
    /// status() or busy() changed; at most some twenty times a second for progress.
    void statusChanged();
    /// A task without a `failed` of its own threw.
    void taskFailed(const QString& title, const searchlight::Error& error);

private:
    struct Task;
    struct Lane;

    Lane& lane(const std::string& name);
    void cancelOf(QObject* receiver);
    void ended(const std::shared_ptr<Task>& task);

    std::map<std::string, std::unique_ptr<Lane>> lanes_;
    std::vector<std::shared_ptr<Task>> tasks_;  ///< that run or wait
    std::uint64_t next_id_ = 1;
    std::atomic<bool> hold_background_ = false;
};

}  // namespace searchlight::gui

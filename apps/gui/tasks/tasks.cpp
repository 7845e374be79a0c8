#include "gui/tasks/tasks.h"

#include <QMetaObject>
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <new>
#include <optional>
#include <thread>

namespace searchlight::gui {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

struct Tasks::Task {
    std::uint64_t id = 0;
    TaskSpec spec;
    QPointer<QObject> receiver;  // read on the window's thread only
    bool has_receiver = false;
    std::function<void(TaskContext&)> work;
    std::function<void(const Error&)> failed;

    std::atomic<bool> cancelled = false;
    std::atomic<bool> running = false;
    mutable std::mutex mutex;  // of what follows, which the lane writes and the window reads
    Clock::time_point begun = Clock::now();
    Clock::time_point told = begun;
    std::string part;  // that the progress is of
    Clock::time_point part_begun = begun;
    std::uint64_t part_start = 0;
    double fraction = -1, left = -1;
};

struct Tasks::Lane {
    std::mutex mutex;
    std::condition_variable wake;
    std::deque<std::shared_ptr<Task>> queue;
    bool stop = false;
    std::vector<std::function<void()>> at_end;
    std::thread thread;
};

namespace {

class LaneContext : public TaskContext {
public:
    LaneContext(Tasks& owner, Engine& engine, std::function<void(std::function<void()>)> post,
                std::function<bool()> cancelled,
                std::function<bool(std::string_view, std::uint64_t, std::uint64_t)> progress)
        : owner_(owner),
          engine_(engine),
          post_(std::move(post)),
          cancelled_(std::move(cancelled)),
          progress_(std::move(progress)) {}

    Engine& engine() override { return engine_; }
    void publish(std::function<void()> deliver) override { post_(std::move(deliver)); }
    bool cancelled() const override { return cancelled_(); }
    void progress(std::string_view task, std::uint64_t done, std::uint64_t total, std::string_view) override {
        if (total > 0 && progress_(task, done, total))
            QMetaObject::invokeMethod(&owner_, &Tasks::statusChanged, Qt::QueuedConnection);
    }

private:
    Tasks& owner_;
    Engine& engine_;
    std::function<void(std::function<void()>)> post_;
    std::function<bool()> cancelled_;
    std::function<bool(std::string_view, std::uint64_t, std::uint64_t)> progress_;
};

}  // namespace

Tasks::Tasks(QObject* parent) : QObject(parent) {}

Tasks::~Tasks() {
    for (const auto& task : tasks_) task->cancelled = true;
    for (auto& [name, each] : lanes_) {
        const std::lock_guard lock(each->mutex);
        each->stop = true;
        each->queue.clear();
        each->wake.notify_all();
    }
    for (auto& [name, each] : lanes_) each->thread.join();
}

std::uint64_t Tasks::start(TaskSpec spec, std::function<void(TaskContext&)> work,
                           std::function<void(const Error&)> failed) {
    cancel(spec.lane, spec.key);
    auto task = std::make_shared<Task>();
    task->id = next_id_++;
    task->receiver = spec.receiver;
    task->has_receiver = spec.receiver != nullptr;
    task->spec = std::move(spec);
    task->work = std::move(work);
    task->failed = std::move(failed);
    tasks_.push_back(task);
    if (task->receiver) connect(task->receiver, &QObject::destroyed, this, &Tasks::cancelOf, Qt::UniqueConnection);
    Lane& home = lane(task->spec.lane);
    {
        const std::lock_guard lock(home.mutex);
        home.queue.push_back(task);
    }
    home.wake.notify_one();
    emit statusChanged();
    return task->id;
}

void Tasks::cancel(std::uint64_t id) {
    for (const auto& task : tasks_)
        if (task->id == id) task->cancelled = true;
}

void Tasks::cancel(const std::string& lane_name, const std::string& key) {
    for (const auto& task : tasks_)
        if (task->spec.lane == lane_name && task->spec.key == key) task->cancelled = true;
}

void Tasks::cancelOf(QObject* receiver) {
    for (const auto& task : tasks_)
        if (task->spec.receiver == receiver) task->cancelled = true;
}

bool Tasks::busy() const {
    return std::ranges::any_of(tasks_, [](const auto& task) { return !task->cancelled; });
}

std::vector<TaskStatus> Tasks::status() const {
    std::vector<TaskStatus> list;
    for (const auto& task : tasks_) {
        if (task->spec.title.isEmpty() || task->cancelled || !task->running) continue;
        const std::lock_guard lock(task->mutex);
        list.push_back({task->id, task->spec.title, task->fraction, secondsSince(task->begun), task->left});
    }
    return list;
}

void Tasks::atLaneEnd(const std::string& lane_name, std::function<void()> clean) {
    Lane& home = lane(lane_name);
    const std::lock_guard lock(home.mutex);
    home.at_end.push_back(std::move(clean));
}

void Tasks::ended(const std::shared_ptr<Task>& task) {
    std::erase(tasks_, task);
    emit statusChanged();
}

Tasks::Lane& Tasks::lane(const std::string& name) {
    std::unique_ptr<Lane>& found = lanes_[name];
    if (found) return *found;
    found = std::make_unique<Lane>();
    Lane* const self = found.get();
    self->thread = std::thread([this, self] {
        Engine engine;
        const auto onWindow = [this](std::function<void()> call) {
            QMetaObject::invokeMethod(this, std::move(call), Qt::QueuedConnection);
        };
        while (true) {
            std::shared_ptr<Task> task;
            {
                std::unique_lock lock(self->mutex);
                self->wake.wait(lock, [&] { return self->stop || !self->queue.empty(); });
                if (self->stop) break;
                const auto held = [&] {
                    const Task& first = *self->queue.front();
                    return hold_background_ && first.spec.background && !first.cancelled;
                };
                if (held()) {
                    using namespace std::chrono_literals;
                    self->wake.wait_for(lock, 10ms);
                    continue;
                }
                task = self->queue.front();
                self->queue.pop_front();
            }
            const auto wanted = [task] { return !task->cancelled && (!task->has_receiver || task->receiver); };
            const auto post = [&](std::function<void()> deliver) {
                onWindow([wanted, deliver = std::move(deliver)] {
                    if (wanted()) deliver();
                });
            };
            const auto progress = [task](std::string_view part, std::uint64_t done, std::uint64_t total) {
                using namespace std::chrono_literals;
                const std::lock_guard lock(task->mutex);
                if (part != task->part || done < task->part_start) {
                    task->part = part;
                    task->part_begun = Clock::now();
                    task->part_start = done;
                    task->left = -1;
                }
                task->fraction = std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
                if (done > task->part_start)
                    task->left = secondsSince(task->part_begun) / static_cast<double>(done - task->part_start) *
                                 static_cast<double>(total - std::min(done, total));
                if (Clock::now() - task->told < 50ms) return false;
                task->told = Clock::now();
                return true;
            };
            std::optional<Error> error;
            if (!task->cancelled) {
                {
                    const std::lock_guard lock(task->mutex);
                    task->begun = task->told = task->part_begun = Clock::now();
                }
                task->running = true;
                LaneContext context(
                    *this, engine, post, [task] { return task->cancelled.load(); }, progress);
                try {
                    task->work(context);
                } catch (const Error& thrown) {
                    if (thrown.kind != ErrorKind::interrupted) error = thrown;
                } catch (const std::bad_alloc&) {
                    error =
                        deviceError("out of memory", "fewer points, a smaller picture or a smaller shape take less");
                } catch (const std::exception& thrown) {
                    error = inputError(thrown.what());
                }
            }
            // Captured results go before the window hears of the end.
            task->work = nullptr;
            onWindow([this, task, wanted, error] {
                const bool tell = error && wanted();
                ended(task);
                if (!tell) return;
                if (task->failed)
                    task->failed(*error);
                else
                    emit taskFailed(task->spec.title, *error);
            });
        }
        for (auto& clean : self->at_end) clean();
    });
    return *found;
}

}  // namespace searchlight::gui

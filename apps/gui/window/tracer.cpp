#include "gui/window/tracer.h"

#include <QEvent>
#include <QWidget>
#include <algorithm>
#include <ctime>

#include "gui/material/material_edit.h"

namespace searchlight::gui {

namespace {

constexpr int moves = 12, between_moves_ms = 350, beat_ms = 10;
constexpr double blocked_ms = 100;

// CPU time of this thread.
double threadMs() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
}

}  // namespace

Tracer::Tracer(Desk& desk, QWidget* window, QElapsedTimer started, QObject* parent)
    : QObject(parent), desk_(desk), started_(started) {
    window->installEventFilter(this);
    connect(&desk_.trace, &Trace::happened, this, &Tracer::happened);
    connect(&heart_, &QTimer::timeout, this, [this] {
        const auto note = [](Blocks& blocks, double ms) {
            blocks.longest_ms = std::max(blocks.longest_ms, ms);
            if (ms > blocked_ms) ++blocks.count;
        };
        const double own_ms = threadMs();
        note(blocks_, static_cast<double>(beat_.nsecsElapsed()) * 1e-6 - beat_ms);
        note(own_blocks_, own_ms - own_ms_);
        own_ms_ = own_ms;
        beat_.restart();
    });
}

bool Tracer::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::Paint && window_ms_ < 0) {
        window_ms_ = static_cast<double>(started_.elapsed());
        // Before the first paint there is nothing to be blocked.
        heart_.start(beat_ms);
        beat_.start();
        own_ms_ = threadMs();
    }
    return QObject::eventFilter(watched, event);
}

void Tracer::happened(const QString& what) {
    first_.try_emplace(what, static_cast<double>(started_.elapsed()));
    if (exercising_ && moves_done_ > answered_[what]) {
        answered_[what] = moves_done_;
        after_move_[what].push_back(static_cast<double>(moved_.nsecsElapsed()) * 1e-6);
    }
    if (what == "picture" && moves_left_ > 0 && !exercising_) {
        exercising_ = true;
        nextMove();
    }
}

void Tracer::exercise() {
    moves_left_ = moves;
    if (first_.contains("picture") && !exercising_) {
        exercising_ = true;
        nextMove();
    }
}

void Tracer::nextMove() {
    if (moves_left_ == 0) {
        desk_.workspace.undoStack().undo();
        exercising_ = false;
        emit exercised();
        return;
    }
    --moves_left_;
    ++moves_done_;
    moved_.restart();
    desk_.workspace.edit(tr("Absorption"), "trace", [this](State& state) {
        SceneMaterial& material = state.scene.material;
        material = spelledOut(material);
        std::vector<double>& list = material.inverted() ? material.ld : material.sigma_a;
        for (double& each : list) each *= moves_left_ % 2 == 0 ? 1.3 : 1 / 1.25;
    });
    QTimer::singleShot(between_moves_ms, this, &Tracer::nextMove);
}

QString Tracer::report() const {
    QString text = QString("ms to window %1\n").arg(window_ms_, 0, 'f', 0);
    const auto line = [&](const char* what, const QString& event) {
        const auto found = first_.find(event);
        if (found != first_.end()) text += QString("ms to first %1 %2\n").arg(what).arg(found->second, 0, 'f', 0);
    };
    line("picture", "preview");
    line("complete picture", "picture");
    line("curves", "curves");
    line("reference", "reference");
    for (const auto& [what, values] : after_move_)
        if (what != "picture")
            text += QString("ms from slider to %1: median %2, longest %3, of %4\n")
                        .arg(what)
                        .arg(median(values), 0, 'f', 1)
                        .arg(*std::ranges::max_element(values), 0, 'f', 1)
                        .arg(values.size());
    const auto block = [&](const char* what, const Blocks& blocks) {
        text += QString("%1 more than %2 ms: %3 times, longest %4 ms\n")
                    .arg(what)
                    .arg(blocked_ms)
                    .arg(blocks.count)
                    .arg(blocks.longest_ms, 0, 'f', 0);
    };
    block("event loop blocked", blocks_);
    block("event loop busy by itself", own_blocks_);
    return text;
}

}  // namespace searchlight::gui

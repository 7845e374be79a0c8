// What `--trace` prints: how long a person waits for what, measured by the program itself.
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <map>
#include <vector>

#include "gui/window/desk.h"

namespace searchlight::gui {

class Tracer : public QObject {
    Q_OBJECT

public:
    /// `started`: when the program began. `window` is watched for its first paint.
    Tracer(Desk& desk, QWidget* window, QElapsedTimer started, QObject* parent = nullptr);

    /// "ms to window 180", a line each.
    QString report() const;

    /// Moves a slider back and forth once the first picture is complete, and notes how long pictures and curves take to
    /// follow. Undone afterwards.
    void exercise();

    /// How often the event loop did not come round for more than 100 ms, and the longest; of that, the window's own
    /// work (CPU time of its thread), which does not count other programs.
    struct Blocks {
        int count = 0;
        double longest_ms = 0;
    };
    const Blocks& blocks() const { return blocks_; }
    const Blocks& ownBlocks() const { return own_blocks_; }

Q_SIGNALS:
    void exercised();

protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

private:
    void happened(const QString& what);
    void nextMove();

    Desk& desk_;
    QElapsedTimer started_, moved_, beat_;
    QTimer heart_;
    double window_ms_ = -1, own_ms_ = 0;
    Blocks blocks_, own_blocks_;
    int moves_left_ = 0, moves_done_ = 0;
    bool exercising_ = false;
    std::map<QString, double> first_;
    std::map<QString, std::vector<double>> after_move_;
    std::map<QString, int> answered_;
};

}  // namespace searchlight::gui

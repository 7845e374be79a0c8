#include "gui/kernel/kernel_dock.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QScrollArea>
#include <QStackedWidget>
#include <QVBoxLayout>
#include <array>
#include <memory>
#include <optional>

#include "gui/kernel/export_button.h"
#include "gui/kernel/kernel_options.h"
#include "gui/kernel/live_kernels.h"
#include "gui/kernel/manual_panel.h"
#include "gui/kernel/method_table.h"
#include "gui/kernel/picture_row.h"
#include "gui/plot/figure_view.h"
#include "gui/plot/option_bar.h"
#include "gui/window/seen.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr const char* kLane = "kernels";
constexpr int kTableWidth = 364, kSlidersWidth = 312;
// Of what is looked at, beside the table; of two figures beside each other.
constexpr int kStageWidth = 600, kFiguresWidth = 480;

struct LaneKernels {
    std::optional<LiveKernels> kernels;
};

class KernelDock : public QWidget {
public:
    explicit KernelDock(Desk& desk) : desk_(desk), lane_(std::make_shared<LaneKernels>()), seen_(this) {
        connect(&seen_, &Seen::changed, this, &KernelDock::setSeen);
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        layout->addWidget(makeBar());
        auto* middle = new QHBoxLayout;
        middle->setSpacing(0);
        table_ = new MethodTable(desk.theme, this);
        table_->setObjectName(QStringLiteral("kernel.table"));
        table_->setAccessibleName(tr("Kernels with their errors"));
        middle->addWidget(table_, 1);
        stage_ = new QStackedWidget(this);
        stage_->addWidget(makeFigures());
        pictures_ = new PictureRow(desk.theme, stage_);
        pictures_->setObjectName(QStringLiteral("kernel.pictures"));
        pictures_->setAccessibleName(tr("A picture before, after, and the difference"));
        pictures_->setToolTip(tr("The difference is relative to the mean: blue is too dark, orange too bright."));
        stage_->addWidget(pictures_);
        middle->addWidget(stage_, 2);
        middle->addWidget(makeSliders());
        layout->addLayout(middle, 1);
        status_ = new QLabel(this);
        status_->setObjectName(QStringLiteral("kernel.status"));
        status_->setFont(desk.theme.smallFont());
        status_->setContentsMargins(Space::s, Space::xs, Space::s, Space::xs);
        status_->setTextInteractionFlags(Qt::TextSelectableByMouse);
        // A long line must not widen the dock.
        status_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
        layout->addWidget(status_);
        connect(table_, &MethodTable::chosen, this, [this](const QString& name) {
            desk_.workspace.setOption(tr("Kernel"), "kernel", "method", name.toStdString());
            desk_.workspace.endGesture();
        });
        desk_.tasks.atLaneEnd(kLane, [kept = lane_] { kept->kernels.reset(); });
        connect(&desk_.workspace, &Workspace::changed, this, [this](Change change) {
            if (change.any({Part::material, Part::models, Part::parameters, Part::active, Part::options, Part::seed}))
                refresh();
        });
        connect(&desk_.workspace, &Workspace::modelFileChanged, this, [this] { refresh(); });
        arrange();
    }

protected:
    void resizeEvent(QResizeEvent* event) override {
        QWidget::resizeEvent(event);
        arrange();
    }

private:
    QWidget* makeBar() {
        auto* bar = new OptionBar(desk_, "kernel", this);
        bar->addChoice("view", tr("View"), {tr("Curves"), tr("Edge"), tr("Pictures"), tr("Table")});
        QStringList names;
        for (const NamedMethod& method : namedMethods(17)) names << QString::fromStdString(method.name);
        bar->addChoice("method", tr("Kernel"), names);
        channel_ = bar->addChoice("channel", tr("Channel"), {tr("Red"), tr("Green"), tr("Blue")});
        signal_ = bar->addChoice("signal", tr("Signal"),
                                 {tr("Edge"), tr("Tilted edges"), tr("Discs"), tr("Tilted squares"), tr("Points"),
                                  tr("Skin, shaded"), tr("Skin, evenly lit")});
        bar->addChoice("taps", tr("Taps"), {tr("7 taps"), tr("11 taps"), tr("17 taps"), tr("25 taps"), tr("41 taps")});
        bar->addChoice("truth", tr("Ground truth"), {tr("Walks"), tr("Active model")});
        export_ = new KernelExportButton(desk_, this);
        bar->addWidget(export_);
        return bar;
    }

    // Axis and diagonal, or an edge and its error: one figure each, so that each can be zoomed and read.
    QWidget* makeFigures() {
        curves_ = new QWidget(stage_);
        auto* row = new QHBoxLayout(curves_);
        row->setContentsMargins(0, 0, 0, 0);
        row->setSpacing(0);
        static constexpr const char* names[] = {"kernel.figure", "kernel.figure.second"};
        for (std::size_t i = 0; i < figures_.size(); ++i) {
            halves_[i] = new QWidget(curves_);
            auto* column = new QVBoxLayout(halves_[i]);
            column->setContentsMargins(0, 0, 0, 0);
            column->setSpacing(0);
            titles_[i] = new QLabel(halves_[i]);
            titles_[i]->setAlignment(Qt::AlignCenter);
            titles_[i]->setFont(desk_.theme.smallFont());
            column->addWidget(titles_[i]);
            figures_[i] = new FigureView(desk_, halves_[i]);
            figures_[i]->setObjectName(QLatin1String(names[i]));
            figures_[i]->setMinimumSize(100, 100);
            figures_[i]->setLegendBeside();
            column->addWidget(figures_[i], 1);
            row->addWidget(halves_[i], 1);
        }
        return curves_;
    }

    void showFigures(const Figure& figure, const QString& empty) {
        for (std::size_t i = 0; i < figures_.size(); ++i) {
            const bool there = i < figure.panels.size();
            figures_[i]->setFigure(there ? figure.panels[i] : Figure(), i == 0 ? empty : QString());
            titles_[i]->setText(there ? QString::fromStdString(figure.panels[i].title) : QString());
            figures_[i]->setAccessibleName(titles_[i]->text());
        }
    }

    QWidget* makeSliders() {
        manual_ = new ManualPanel(desk_.theme, this);
        manual_->setObjectName(QStringLiteral("panel"));
        sliders_ = new QScrollArea(this);
        sliders_->setObjectName(QStringLiteral("panel"));
        sliders_->setWidget(manual_);
        sliders_->setWidgetResizable(true);
        sliders_->setFixedWidth(kSlidersWidth);
        sliders_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        connect(manual_, &ManualPanel::edited, this, [this] {
            desk_.workspace.edit(tr("Two Gaussians"), QStringLiteral("kernel.manual"),
                                 [this](State& state) { setManual(state, manual_->values()); });
        });
        connect(manual_, &ManualPanel::finished, &desk_.workspace, &Workspace::endGesture);
        connect(manual_, &ManualPanel::fitWanted, this,
                [this] { desk_.workspace.setOption(tr("Two Gaussians"), "kernel", "by_hand", false); });
        return sliders_;
    }

    // What stands beside what, for the width and the view.
    void arrange() {
        const KernelWish wish = kernelWish(desk_.workspace.state());
        const bool of_table = wish.view == "table", by_hand = wish.method == "manual";
        const int room = width() - (by_hand ? kSlidersWidth : 0);
        const bool beside = room >= kTableWidth + kStageWidth;
        table_->setVisible(beside || of_table);
        table_->setMaximumWidth(of_table ? QWIDGETSIZE_MAX : kTableWidth);
        stage_->setVisible(!of_table);
        stage_->setCurrentWidget(wish.view == "pictures" ? static_cast<QWidget*>(pictures_) : curves_);
        table_->setMinimumWidth(of_table ? 0 : kTableWidth);
        sliders_->setVisible(by_hand);
        halves_[1]->setVisible(room >= kFiguresWidth);
        channel_->setEnabled(wish.view == "curves" || wish.view == "edge");
        signal_->setEnabled(wish.view == "pictures");
        table_->setChosen(wish.method);
    }

    // Walks cost both cores: none for what nobody sees.
    void setSeen(bool seen) {
        if (seen) return refresh();
        desk_.tasks.cancel(kLane, "kernels");
        working_ = pending_ = false;
    }

    // As in the plot: a kernel that is under way is shown before the next wish begins, so that a slider that moves fast
    // still shows kernels on its way.
    void refresh() {
        arrange();
        if (!seen_.now()) return;
        if (working_) {
            pending_ = true;
            return;
        }
        pending_ = false;
        working_ = true;
        setProperty("settled", false);
        desk_.tasks.start(
            {.lane = kLane, .key = "kernels", .title = tr("Kernels"), .receiver = this},
            [this, kept = lane_, wish = kernelWish(desk_.workspace.state())](TaskContext& context) {
                if (!kept->kernels) kept->kernels.emplace(context.engine());
                LiveKernels& kernels = *kept->kernels;
                const auto publish = [&] {
                    context.publish([this, shown = std::make_shared<const KernelShown>(kernels.show(wish)),
                                     name = wish.method] { show(shown, name); });
                };
                if (!kernels.hasTruth(wish)) kernels.improveTruth(wish, context);
                do publish();
                while (kernels.improveTruth(wish, context));
                // FLIP costs more than all else: it comes when the rest of the table stands.
                for (const bool perceptual : {false, true})
                    for (const NamedMethod& method : namedMethods(wish.taps)) {
                        if (context.cancelled()) return;
                        context.publish([this, judged = kernels.row(wish, method, perceptual), name = method.name,
                                         perceptual] { table_->setRow(name, *judged, perceptual); });
                    }
                context.publish([this] { setProperty("settled", true); });
            },
            [this](const Error& error) { failed(error); });
    }

    void show(const std::shared_ptr<const KernelShown>& shown, const std::string& name) {
        const KernelWish wish = kernelWish(desk_.workspace.state());
        const bool other_rows = !shown_ || shown_->base != shown->base || shown_taps_ != wish.taps;
        shown_ = shown;
        shown_taps_ = wish.taps;
        if (other_rows) table_->clearRows();
        table_->setRow(name, *shown->judged, false);
        manual_->setValues(wish.manual.value_or(shown->base->fitted), wish.manual.has_value());
        showFigures(shown->figure, tr("This channel does not scatter: its kernel is a delta."));
        const KernelPictures& pictures = shown->pictures;
        if (!pictures.before.isNull())
            pictures_->setPanels(
                {{tr("Before"), tr("%1 mm wide").arg(128 * shown->base->judge.pixel(), 0, 'g', 3), pictures.before},
                 {tr("After the truth"), tr("by Fourier transforms"), pictures.exact},
                 {tr("After the kernel"), tr("%1 taps, %2 passes").arg(wish.taps).arg(2 * shown->judged->made.rank()),
                  pictures.filtered},
                 {tr("Difference"),
                  tr("RMS %1, scale ±%2 %").arg(pictures.rms, 0, 'f', 4).arg(100 * kKernelDifferenceScale),
                  pictures.difference}});
        export_->setKernel(shown_);
        status_->setText(statusText(*shown));
        status_->setToolTip(status_->text());
        stepped();
    }

    static QString statusText(const KernelShown& shown) {
        const JudgedKernel& judged = *shown.judged;
        const Rgb rms = judged.kernel_rms;
        QStringList parts;
        parts << QString::fromStdString(judged.made.name);
        parts << tr("pictures RMS %1").arg(judged.overall, 0, 'f', 4);
        parts << tr("kernel space R %1  G %2  B %3").arg(rms.r, 0, 'f', 3).arg(rms.g, 0, 'f', 3).arg(rms.b, 0, 'f', 3);
        parts << tr("made in %1 ms").arg(1e3 * judged.seconds, 0, 'f', 1);
        parts << tr("%1 against %2")
                     .arg(QString::fromStdString(shown.base->subject.name),
                          QString::fromStdString(shown.base->truth.label));
        return parts.join(QStringLiteral("  ·  "));
    }

    void failed(const Error& error) {
        shown_.reset();
        showFigures({}, QString::fromUtf8(error.what()));
        pictures_->setPanels({});
        table_->clearRows();
        export_->setKernel(nullptr);
        status_->setText(QString::fromStdString(error.message));
        stepped();
        setProperty("settled", true);
    }

    void stepped() {
        working_ = false;
        if (pending_) refresh();
    }

    Desk& desk_;
    std::shared_ptr<LaneKernels> lane_;
    std::shared_ptr<const KernelShown> shown_;
    MethodTable* table_ = nullptr;
    QStackedWidget* stage_ = nullptr;
    QWidget* curves_ = nullptr;
    std::array<QWidget*, 2> halves_{};
    std::array<QLabel*, 2> titles_{};
    std::array<FigureView*, 2> figures_{};
    PictureRow* pictures_ = nullptr;
    QScrollArea* sliders_ = nullptr;
    ManualPanel* manual_ = nullptr;
    QComboBox *channel_ = nullptr, *signal_ = nullptr;
    KernelExportButton* export_ = nullptr;
    QLabel* status_ = nullptr;
    int shown_taps_ = 0;
    Seen seen_;
    bool working_ = false, pending_ = false;
};

}  // namespace

QWidget* makeKernelDock(Desk& desk) { return new KernelDock(desk); }

}  // namespace searchlight::gui

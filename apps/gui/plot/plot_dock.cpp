#include "gui/plot/plot_dock.h"

#include <QApplication>
#include <QClipboard>
#include <QComboBox>
#include <QFileDialog>
#include <QLabel>
#include <QMenu>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <memory>
#include <optional>

#include "draw/draw.h"
#include "gui/models/model_status.h"
#include "gui/plot/figure_view.h"
#include "gui/plot/option_bar.h"
#include "gui/plot/plot_options.h"
#include "gui/window/theme.h"

namespace searchlight::gui {

namespace {

constexpr const char* kLane = "curves";

// What stays on the lane's thread from one drawing to the next.
struct LanePlot {
    std::optional<LivePlot> plot;
};

// A lost context is made anew, once.
LivePlotResult drawSafely(LivePlot& plot, const LiveRequest& request, LiveDetail detail, Engine& engine) {
    LivePlotResult result = plot.draw(request, detail);
    if (!engine.contextLost()) return result;
    plot.forgetModels();
    engine.dropContext();
    return plot.draw(request, detail);
}

class PlotDock : public QWidget {
public:
    explicit PlotDock(Desk& desk) : desk_(desk), lane_plot_(std::make_shared<LanePlot>()) {
        auto* layout = new QVBoxLayout(this);
        layout->setContentsMargins(0, 0, 0, 0);
        layout->setSpacing(0);
        view_ = new FigureView(desk, this);
        layout->addWidget(makeBar());
        view_->setObjectName(QStringLiteral("plot.figure"));
        layout->addWidget(view_, 1);
        status_ = new QLabel(this);
        status_->setObjectName(QStringLiteral("plot.status"));
        status_->setFont(desk.theme.smallFont());
        status_->setContentsMargins(Space::s, Space::xs, Space::s, Space::xs);
        status_->setTextInteractionFlags(Qt::TextSelectableByMouse);
        layout->addWidget(status_);
        desk_.tasks.atLaneEnd(kLane, [kept = lane_plot_] { kept->plot.reset(); });
        connect(&desk_.workspace, &Workspace::changed, this, [this](Change change) {
            const bool inverted = desk_.workspace.state().scene.material.inverted();
            if (change.any({Part::material, Part::models, Part::parameters, Part::options, Part::seed}) ||
                (inverted && change.has(Part::active)))
                refresh();
        });
        connect(&desk_.workspace, &Workspace::modelFileChanged, this, [this] { refresh(); });
        refresh();
    }

private:
    QWidget* makeBar() {
        auto* bar = new OptionBar(desk_, "plot", this);
        bar->addChoice("view", tr("Plot"),
                       {tr("Profile"), tr("Relative error"), tr("Plane of incidence"), tr("Surface")});
        bar->addChoice("channel", tr("Channel"), {tr("Red"), tr("Green"), tr("Blue"), tr("Luminance")});
        y_scale_ = bar->addChoice("y_scale", tr("Scale of R_d"), {tr("y linear"), tr("y log"), tr("y square root")});
        x_scale_ = bar->addChoice("x_scale", tr("Scale of r"), {tr("x linear"), tr("x log"), tr("x square root")});
        times_radius_ = bar->addChoice("times_radius", tr("Times radius"), {tr("R_d"), tr("R_d · r"), tr("R_d · r²")});
        bar->addNumber("angle_deg", tr("Angle of incidence"), 0, 5);
        bar->addChoice("walks", tr("Reference"),
                       {tr("No reference"), tr("10⁵ walks"), tr("10⁶ walks"), tr("10⁷ walks")});
        auto* more = new QToolButton(this);
        more->setObjectName(QStringLiteral("plot.export"));
        more->setText(tr("Export"));
        more->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
        const auto paint = [this, more] { more->setIcon(desk_.theme.icon(QStringLiteral("export"))); };
        paint();
        connect(&desk_.theme, &Theme::changed, more, paint);
        more->setAccessibleName(tr("Export the plot"));
        more->setPopupMode(QToolButton::InstantPopup);
        auto* menu = new QMenu(more);
        menu->addAction(tr("Save figure…"), this, [this] { saveFigure(); });
        menu->addAction(tr("Copy as command line"), this,
                        [this] { QApplication::clipboard()->setText(plotCommandLine(desk_.workspace.state())); });
        menu->addAction(tr("Show all of it"), view_, [this] { view_->resetZoom(); });
        more->setMenu(menu);
        bar->addWidget(more);
        return bar;
    }

    void saveFigure() {
        if (view_->isEmpty()) return;
        QStringList filters;
        for (const std::string& ending : figureFormats())
            filters << QStringLiteral("%1 (*%2)")
                           .arg(QString::fromStdString(ending).mid(1).toUpper(), QString::fromStdString(ending));
        const QString path = QFileDialog::getSaveFileName(this, tr("Save figure"), QStringLiteral("searchlight.svg"),
                                                          filters.join(QStringLiteral(";;")));
        if (path.isEmpty()) return;
        try {
            drawFigure(view_->figure(), path.toStdString());
            desk_.notices.post(Notices::Level::info, tr("Saved %1").arg(path));
        } catch (const Error& error) {
            desk_.notices.post(error);
        }
    }

    // One drawing at a time: while one is under way, only that there is a newer wish is kept, so that a slider that
    // moves fast still shows curves on its way.
    void refresh() {
        if (drawing_) {
            pending_ = true;
            return;
        }
        drawing_ = true;
        pending_ = false;
        LiveRequest request;
        try {
            request = plotRequest(desk_.workspace.state());
        } catch (const Error& error) {
            return failed(error);
        }
        using View = LiveRequest::View;
        y_scale_->setEnabled(request.view == View::profile || request.view == View::plane);
        x_scale_->setEnabled(request.view == View::profile || request.view == View::error);
        times_radius_->setEnabled(request.view == View::profile);
        std::vector<std::string> ids;
        for (const LiveModel& model : request.models) ids.push_back(model.model.id);
        desk_.tasks.start(
            {.lane = kLane, .key = "plot", .title = tr("Walking the reference"), .receiver = this},
            [this, request, ids, kept = lane_plot_](TaskContext& context) {
                if (!kept->plot) kept->plot.emplace(context.engine());
                LivePlot& plot = *kept->plot;
                const auto show = [&](LiveDetail detail) {
                    auto result = std::make_shared<LivePlotResult>(drawSafely(plot, request, detail, context.engine()));
                    context.publish([this, result, ids] { shown(*result, ids); });
                };
                if (plot.isSlow(request)) show(LiveDetail::coarse);
                show(LiveDetail::fine);
                while (plot.improve(request, context)) show(LiveDetail::fine);
                context.publish([this] { finished(); });
            },
            [this](const Error& error) { failed(error); });
    }

    void shown(const LivePlotResult& result, const std::vector<std::string>& ids) {
        ModelStatus& status = ModelStatus::of(desk_.workspace);
        QStringList problems;
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const auto found = std::ranges::find(result.problems, i, &LiveProblem::model);
            status.set(ids[i], found == result.problems.end() ? std::nullopt : std::optional(found->error));
            if (found != result.problems.end()) problems << QString::fromUtf8(found->error.what());
        }
        const bool has_reference = !result.reference.empty();
        QString empty = problems.join(QLatin1Char('\n'));
        if (ids.empty())
            empty = tr("No model is visible: show one in Models.");
        else if (empty.isEmpty())
            empty = QString::fromStdString(result.reference_note);
        view_->setFigure(result.figure, empty);
        QStringList parts;
        if (has_reference)
            parts << QString::fromStdString(result.reference) + tr(", band ±2 standard errors");
        else if (!result.reference_note.empty())
            parts << QString::fromStdString(result.reference_note);
        parts << tr("curves %1 ms").arg(result.model_ms, 0, 'f', 1);
        if (!problems.isEmpty()) parts << problems.front().section(QLatin1Char('\n'), 0, 0);
        status_->setText(parts.join(QStringLiteral("  ·  ")));
        if (!result.figure.series.empty() || !result.figure.panels.empty()) desk_.trace.shown(QStringLiteral("curves"));
        if (has_reference) desk_.trace.shown(QStringLiteral("reference"));
        nextWish();
    }

    void failed(const Error& error) {
        view_->setFigure({}, QString::fromUtf8(error.what()));
        status_->setText(QString::fromStdString(error.message));
        nextWish();
    }

    void finished() { setProperty("settled", true); }

    void nextWish() {
        drawing_ = false;
        setProperty("settled", false);
        if (pending_) refresh();
    }

    Desk& desk_;
    std::shared_ptr<LanePlot> lane_plot_;
    FigureView* view_ = nullptr;
    QComboBox *y_scale_ = nullptr, *x_scale_ = nullptr, *times_radius_ = nullptr;
    QLabel* status_ = nullptr;
    bool drawing_ = false, pending_ = false;
};

}  // namespace

QWidget* makePlotDock(Desk& desk) { return new PlotDock(desk); }

}  // namespace searchlight::gui

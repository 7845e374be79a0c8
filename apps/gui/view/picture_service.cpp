#include "gui/view/picture_service.h"

#include <fmt/format.h>

#include <QFileInfo>
#include <algorithm>
#include <cmath>

#include "gui/view/technique_options.h"
#include "model/model.h"

namespace searchlight::gui {

namespace {

constexpr int rest_ms = 160;            // after the last change, before the full picture
constexpr int first_picture_ms = 2000;  // that a window has to be shown in
constexpr double wanted_ms = 70;        // of a preview, so that it is there within 100
constexpr std::uint64_t most_walks = 20'000'000;

QString textOption(const State& state, const char* name) {
    return QString::fromStdString(std::get<std::string>(optionOf(state, "view", name)));
}

// Equal keys: the exposure that suited one picture suits the other. The material is not in it, so that a slider shows
// how much light is lost and no automaton hides it.
std::string exposureKey(const State& state) {
    Scene scene;
    scene.object = state.scene.object;
    scene.scale = 1;
    scene.lights = state.scene.lights;
    return sceneJson(scene) + std::get<std::string>(optionOf(state, "view", "layer"));
}

}  // namespace

struct PictureService::Request {
    PictureRequest a;
    std::optional<PictureRequest> b;
    ReferencePicture reference;  ///< in place of b
    bool with_reference = false;
    QString label_a, label_b;
    ToneMap tone_map;
    std::optional<double> exposure;  ///< none: what suits the picture
    std::string channel;
    bool difference = false;
    double difference_scale = 0.2;
};

PictureService::PictureService(Desk& desk, QObject* parent)
    : QObject(parent), desk_(desk), maker_(std::make_shared<PictureMaker>()) {
    rest_.setSingleShot(true);
    rest_.setInterval(rest_ms);
    connect(&rest_, &QTimer::timeout, this, &PictureService::rest);
    connect(&desk_.workspace, &Workspace::changed, this, &PictureService::changed);
    connect(&desk_.workspace, &Workspace::modelFileChanged, this, [this](const QString& id) {
        const TaskSpec spec{.lane = "picture", .key = "model " + id.toStdString(), .receiver = this};
        desk_.tasks.start(spec, [maker = maker_, id = id.toStdString()](TaskContext&) { maker->modelFileChanged(id); });
        request(true);
    });
    // A user may cancel a picture: then nothing is delivered, and the next change begins anew.
    connect(&desk_.tasks, &Tasks::statusChanged, this, [this] {
        if (!working() || desk_.tasks.busy("picture", "picture")) return;
        running_preview_ = running_full_ = false;
        desk_.tasks.holdBackground(false);
        if (pending_) return submit(true);
        emit pictureShown();
    });
    // The first picture goes before what a person looks at later; a window that is never shown holds nothing up.
    desk_.tasks.holdBackground(true);
    QTimer::singleShot(first_picture_ms, this, [this] {
        if (size_.isEmpty()) desk_.tasks.holdBackground(false);
    });
    desk_.tasks.atLaneEnd("picture", [maker = maker_] { maker->clear(); });
}

void PictureService::setSize(QSize size) {
    if (size == size_ || size.isEmpty()) return;
    const bool first = size_.isEmpty();
    size_ = size;
    request(!first);
}

bool PictureService::atRest() const {
    return !running_preview_ && !running_full_ && !pending_ && !rest_.isActive() && shown_.preview == 1 &&
           !shown_.partly;
}

void PictureService::changed(Change change) {
    if (change.empty()) return;
    request(true);
}

void PictureService::request(bool moving) {
    if (size_.isEmpty()) return;
    if (!slider_.isValid()) slider_.start();
    // A preview that runs is worth waiting for: cancelled at each step of a slider, none would ever be seen.
    if (running_preview_) {
        pending_ = true;
        return;
    }
    submit(moving);
}

void PictureService::rest() { submit(false); }

QString PictureService::modelLabel(int model) const {
    const std::string& id = desk_.workspace.state().models[static_cast<std::size_t>(model)].model.id;
    for (const Model& shipped : shippedModels())
        if (shipped.id == id) return QString::fromStdString(shipped.file.title);
    return QFileInfo(QString::fromStdString(id)).completeBaseName();
}

PictureService::Request PictureService::requestOf(bool moving) const {
    const State& state = desk_.workspace.state();
    Request request;
    request.a = {.scene = sceneOf(state, state.active),
                 .technique = state.technique,
                 .technique_options = state.technique_options,
                 .seed = state.seed,
                 .width = size_.width(),
                 .height = size_.height(),
                 .preview = moving ? preview_ : 1,
                 .moving = moving,
                 .layer = std::get<std::string>(optionOf(state, "view", "layer"))};
    request.label_a = modelLabel(state.active);
    const QString compare = textOption(state, "compare"), against = textOption(state, "against");
    if (compare != "none") {
        request.difference = compare == "difference";
        request.difference_scale = std::get<double>(optionOf(state, "view", "difference_scale")) / 100;
        const QString what = against.section(' ', 1);
        if (against.startsWith("model ") && what.toInt() >= 0 && what.toInt() < static_cast<int>(state.models.size())) {
            request.b = request.a;
            request.b->scene = sceneOf(state, what.toInt());
            // Both sides stand for one medium, unless one has its own.
            if (!state.models[static_cast<std::size_t>(what.toInt())].material)
                request.b->inverted_by = state.activeModel().model;
            request.label_b = modelLabel(what.toInt());
        } else if (against.startsWith("technique ")) {
            request.b = request.a;
            request.b->technique = what.toStdString();
            request.b->technique_options.clear();
            request.label_b = techniqueTitle(what.toStdString());
            request.label_a = techniqueTitle(state.technique);
        } else {
            request.with_reference = true;
            // The walks know what leaves the object, and nothing of what stands around it.
            request.a.scene.coat.reset();
            request.a.scene.ground.reset();
            request.a.scene.backdrop.reset();
            request.reference = reference_;
            request.label_b = tr("Reference");
        }
    }
    request.channel = std::get<std::string>(optionOf(state, "view", "channel"));
    request.tone_map.curve = textOption(state, "curve") == "filmic" ? ToneMap::Curve::filmic : ToneMap::Curve::srgb;
    request.tone_map.gamma = std::get<double>(optionOf(state, "view", "gamma"));
    if (!std::get<bool>(optionOf(state, "view", "auto_exposure")))
        request.exposure = std::get<double>(optionOf(state, "view", "exposure"));
    else if (exposure_key_ == exposureKey(state))
        request.exposure = exposure_;
    return request;
}

ViewPicture PictureService::viewOf(const Request& request, const Picture& a, const Picture* b) {
    ViewPicture picture;
    picture.label_a = request.label_a;
    picture.label_b = request.label_b;
    picture.linear_a = a.image;
    picture.report = a.report;
    picture.subject = a.subject;
    picture.preview = request.a.preview;
    picture.exposure = request.exposure.value_or(a.report.exposure);
    ToneMap tone_map = request.tone_map;
    tone_map.exposure = picture.exposure;
    picture.a = shownImage(*a.image, tone_map, request.channel);
    if (b) picture.linear_b = b->image;
    if (request.with_reference && request.reference.image) {
        picture.linear_b = request.reference.image;
        picture.walks = request.reference.walks;
        picture.reference_error = request.reference.relative_error;
    }
    if (!picture.linear_b) return picture;
    const Image &one = *picture.linear_a, &other = *picture.linear_b;
    picture.b = shownImage(other, tone_map, request.channel);
    if (one.width != other.width || one.height != other.height) return picture;
    const auto compare = [&](const Image& x, const Image& y) {
        picture.differs = relativeDifference(x, y, request.channel);
        if (request.difference) picture.difference = differenceImage(x, y, request.difference_scale, request.channel);
    };
    if (a.coverage)
        compare(objectAlone(one, *a.coverage), objectAlone(other, *a.coverage));
    else
        compare(one, other);
    return picture;
}

void PictureService::submit(bool moving) {
    if (size_.isEmpty()) return;
    startReference();
    rest_.stop();
    pending_ = false;
    running_preview_ = moving;
    running_full_ = !moving;
    desk_.tasks.holdBackground(true);
    const Request request = requestOf(moving);
    const TaskSpec spec{.lane = "picture", .key = "picture", .title = tr("Picture"), .receiver = this};
    const auto work = [this, request, moving, maker = maker_](TaskContext& context) {
        QElapsedTimer clock;
        clock.start();
        const auto ms = [&] { return static_cast<double>(clock.nsecsElapsed()) * 1e-6; };
        const auto tell = [&](const Picture& a, const Picture* b) {
            ViewPicture picture = viewOf(request, a, b);
            picture.partly = true;
            picture.ms = ms();
            context.publish([this, picture = std::move(picture)]() mutable { partlyDelivered(std::move(picture)); });
        };
        const Picture a = maker->make("a", request.a, context, [&](const Picture& so_far) { tell(so_far, nullptr); });
        std::optional<Picture> b;
        if (request.b) {
            // The other side may take much longer than this one.
            if (!moving) tell(a, nullptr);
            b = maker->make("b", *request.b, context, [&](const Picture& so_far) { tell(a, &so_far); });
        } else {
            maker->forget("b");
        }
        ViewPicture picture = viewOf(request, a, b ? &*b : nullptr);
        picture.ms = ms();
        context.publish([this, picture = std::move(picture), moving, ms = picture.ms]() mutable {
            delivered(std::move(picture), moving, ms);
        });
    };
    desk_.tasks.start(spec, work, [this](const Error& error) {
        running_preview_ = running_full_ = false;
        desk_.tasks.holdBackground(false);
        emit failed(QString::fromUtf8(error.what()));
        if (pending_) submit(true);
    });
}

void PictureService::partlyDelivered(ViewPicture picture) {
    // A side that is not begun yet keeps what it showed, if that was the same thing.
    if (picture.b.isNull() && picture.label_b == shown_.label_b) {
        picture.b = shown_.b;
        picture.difference = shown_.difference;
        picture.differs = shown_.differs;
    }
    shown_ = std::move(picture);
    emit pictureShown();
}

void PictureService::delivered(ViewPicture picture, bool moving, double ms) {
    running_preview_ = running_full_ = false;
    if (!moving) desk_.tasks.holdBackground(false);
    const State& state = desk_.workspace.state();
    if (!exposure_ || exposure_key_ != exposureKey(state)) {
        exposure_ = picture.exposure;
        exposure_key_ = exposureKey(state);
    }
    // The difference of a preview is not worth a flicker: the last one stays until the picture is complete.
    if (moving && picture.difference.isNull() && !shown_.difference.isNull() && !picture.label_b.isEmpty())
        picture.difference = shown_.difference;
    shown_ = std::move(picture);
    emit pictureShown();
    desk_.trace.shown(moving ? "preview" : "picture");
    if (moving) {
        // So that previews come in time on this machine, and are as fine as it allows.
        preview_ = std::clamp(preview_ * std::clamp(std::sqrt(wanted_ms / std::max(ms, 1.0)), 0.7, 1.2), 0.2, 0.5);
        if (slider_.isValid() && !pending_) slider_.invalidate();
    }
    if (pending_)
        submit(true);
    else if (moving)
        rest_.start();
}

void PictureService::startReference() {
    const State& state = desk_.workspace.state();
    const bool wanted = textOption(state, "compare") != "none" && textOption(state, "against") == "reference";
    if (!wanted) {
        if (!reference_key_.empty()) desk_.tasks.cancel("reference picture", "walks");
        reference_key_.clear();
        reference_ = {};
        return;
    }
    Scene scene = sceneOf(state, state.active);
    if (!scene.material.inverted()) scene.model = {};  // the walks know no model
    scene.ground.reset();
    scene.backdrop.reset();
    scene.coat.reset();
    const std::string key = fmt::format("{} {}x{} {}", sceneJson(scene), size_.width(), size_.height(), state.seed);
    if (key == reference_key_) return;
    reference_key_ = key;
    reference_ = {};
    const TaskSpec spec{
        .lane = "reference picture", .key = "walks", .title = tr("Reference"), .background = true, .receiver = this};
    const auto work = [this, scene, size = size_, seed = state.seed](TaskContext& context) {
        walkPicture(scene, size.width(), size.height(), seed, most_walks, context, [&](ReferencePicture picture) {
            context.publish([this, picture = std::move(picture)] {
                reference_ = picture;
                desk_.trace.shown("reference picture");
                if (!running_preview_ && !rest_.isActive()) submit(false);
            });
        });
    };
    desk_.tasks.start(spec, work, [this](const Error& error) { desk_.notices.post(error); });
}

}  // namespace searchlight::gui

// Keeps the object view's pictures up to date: soon and small while something changes, in full once it rests.
#pragma once

#include <QElapsedTimer>
#include <QImage>
#include <QObject>
#include <QSize>
#include <QTimer>
#include <memory>
#include <optional>

#include "gui/view/picture_maker.h"
#include "gui/view/reference_picture.h"
#include "gui/view/shown_image.h"
#include "gui/window/desk.h"

namespace searchlight::gui {

/// What the view paints.
struct ViewPicture {
    QImage a, b;        ///< shown side by side in a wipe; b is null when nothing is compared
    QImage difference;  ///< null unless asked for
    QString label_a, label_b;
    std::shared_ptr<const Image> linear_a, linear_b;
    RenderReport report;
    Subject subject;
    double exposure = 0;         ///< stops that were used
    double ms = 0;               ///< on the engine's thread
    double preview = 1;          ///< fraction of the full size
    bool partly = false;         ///< a side is still being summed, or missing
    PictureDifference differs;   ///< a from b, as linear pictures
    std::uint64_t walks = 0;     ///< of the reference; 0: b is none
    double reference_error = 0;  ///< of a pixel of it, relative
};

class PictureService : public QObject {
    Q_OBJECT

public:
    explicit PictureService(Desk& desk, QObject* parent = nullptr);

    /// Device pixels.
    void setSize(QSize size);

    const ViewPicture& shown() const { return shown_; }
    /// A picture is being made.
    bool working() const { return running_preview_ || running_full_; }
    /// The last picture is the one of the state, in full.
    bool atRest() const;

Q_SIGNALS:
    /// shown() is another one.
    void pictureShown();
    /// Instead of a picture.
    void failed(const QString& text);

private:
    struct Request;

    void changed(Change change);
    void request(bool moving);
    Request requestOf(bool moving) const;
    void submit(bool moving);
    void partlyDelivered(ViewPicture picture);
    void delivered(ViewPicture picture, bool moving, double ms);
    void rest();
    static ViewPicture viewOf(const Request& request, const Picture& a, const Picture* b);
    void startReference();
    QString modelLabel(int model) const;

    Desk& desk_;
    std::shared_ptr<PictureMaker> maker_;
    QSize size_;
    ViewPicture shown_;
    QTimer rest_;
    bool running_preview_ = false, running_full_ = false, pending_ = false;
    double preview_ = 0.5;
    std::string exposure_key_;        ///< what the exposure was found for
    std::optional<double> exposure_;  ///< stops
    std::string reference_key_;       ///< what the walks are of
    ReferencePicture reference_;
    std::uint64_t asked_ = 0, answered_ = 0;
    QElapsedTimer slider_;  ///< since the change that the next preview answers
};

}  // namespace searchlight::gui

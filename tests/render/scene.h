// A picture of noise under two probes, and the renderer that draws it: what the tests of drawing share.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include "exporting/export.h"
#include "model/deformation.h"
#include "raster/rasterizer.h"
#include "render/driver_drawing.h"
#include "render/picture_texture.h"
#include "render/renderer.h"

namespace probewarp {

/// Noise, opaque but for the pixel at (clear, clear).
template <class Sample>
PicturePtr noise(int width, int height, int clear = -1) {
    Picture picture;
    picture.image.width = width;
    picture.image.height = height;
    std::mt19937 random(13);
    std::vector<Sample> rgba(std::size_t(width) * std::size_t(height) * 4);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        rgba[i] = i % 4 == 3 ? std::numeric_limits<Sample>::max() : Sample(random());
    if (clear >= 0) rgba[std::size_t(clear * width + clear) * 4 + 3] = 0;
    picture.image.rgba = std::move(rgba);
    return std::make_shared<const Picture>(std::move(picture));
}

/// Noise of any alpha, of which a fourth is clear and a fourth opaque.
template <class Sample>
PicturePtr translucent(int width, int height) {
    Picture picture = *noise<Sample>(width, height);
    auto& rgba = std::get<std::vector<Sample>>(picture.image.rgba);
    std::mt19937 random(14);
    for (std::size_t i = 3; i < rgba.size(); i += 4) {
        const auto kind = random() % 4;
        rgba[i] = kind == 0 ? 0 : kind == 1 ? std::numeric_limits<Sample>::max() : Sample(random());
    }
    return std::make_shared<const Picture>(std::move(picture));
}

/// Two probes, one of which moves and turns, so that the picture stretches here, shrinks there, and leaves
/// its frame.
inline Document pulled(PicturePtr picture, double angle) {
    Document document;
    document.picture = std::move(picture);
    const double side = document.picture->image.width;
    Probe probe = new_probe(document, {side * 0.4, side * 0.3});
    probe.now += glm::dvec2(side * 0.1, side * 0.05);
    probe.angle = angle;
    document.probes.push_back(probe);
    document.probes.push_back(new_probe(document, {side * 0.8, side * 0.6}));
    return document;
}

/// A view's pixels, as deep as the image.
inline Image blank(const Image& like, const View& view) {
    Image image;
    image.width = view.width;
    image.height = view.height;
    const std::size_t samples = std::size_t(view.width) * std::size_t(view.height) * 4;
    if (like.bits() == 16)
        image.rgba = std::vector<std::uint16_t>(samples);
    else
        image.rgba = std::vector<std::uint8_t>(samples);
    return image;
}

/// The whole export, of its bands.
inline Image exported(PictureDrawer& drawer, const Deformation& deformation, const View& view,
                      const FileStyle& style = {}) {
    ExportJob job(drawer, deformation, view, style);
    Image whole = blank(job.like(), view);
    std::visit(
        [&](auto& all) {
            for (auto to = all.begin(); !job.done();) {
                const Image band = job.next_band();
                const auto& some = std::get<std::remove_reference_t<decltype(all)>>(band.rgba);
                to = std::copy(some.begin(), some.end(), to);
            }
        },
        whole.rgba);
    return whole;
}

/// A picture under its probes, and the driver's renderer with it. Needs a context.
struct Scene {
    Document document;
    Deformation deformation;
    Renderer renderer;

    explicit Scene(const Document& of) : document(of) {
        update(deformation, document);
        renderer.set_picture(upload_picture(document.picture->image));
        renderer.set_mesh(deformation.binding->mesh, deformation.binding->still);
        renderer.set_positions(deformation.now, deformation.moved);
    }

    View whole(double scale) const {
        View view;
        view.scale = glm::dvec2(scale);
        view.width = int(document.picture->image.width * scale);
        view.height = int(document.picture->image.height * scale);
        return view;
    }

    /// What the driver draws.
    Image by_driver(const View& view, const FileStyle& style = {}) {
        Image image = blank(view);
        DriverDrawing(renderer, view, style).draw_rows(0, image);
        return image;
    }
    /// What the processor draws.
    Image by_processor(const View& view, const FileStyle& style = {}) const {
        Image image = blank(view);
        Rasterizer(deformation, view, style).draw_rows(0, image);
        return image;
    }

    Image blank(const View& view) const { return probewarp::blank(document.picture->image, view); }
};

}  // namespace probewarp

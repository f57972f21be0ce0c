// Draws the deformed picture by OpenGL: the window's renderer, and a heat map's in a file. Everything is
// drawn into framebuffers of its own, whose first row is the top one, so nothing is ever flipped.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <span>

#include "math/dual_complex.h"
#include "model/image.h"
#include "model/mesh.h"
#include "model/probe.h"
#include "model/still_cells.h"
#include "raster/picture_drawer.h"
#include "render/drawn_mesh.h"
#include "render/gl_objects.h"
#include "render/picture_texture.h"

namespace probewarp {

/// Fills the window itself with one colour, before its toolkit draws into it.
void clear_window(int width, int height, glm::vec3 colour);

struct DisplayColours {
    glm::vec3 canvas, light, dark;  ///< beside the picture, and the two of the checkerboard; 0 to 1
    glm::vec4 lines;                ///< of the mesh, straight alpha
};

/// What of the mesh is shown over the picture.
struct ShownMesh {
    bool lines = false;
    double hatching = 0;  ///< of the folded triangles: target pixels from line to line; 0: they are not shown
};

/// What the overlay shows at a vertex.
struct OverlayVertex {
    glm::vec3 colour;  ///< where the style is not a heat map
    float value;       ///< [0, 1]: of the heat map and the iso-lines
};

struct OverlayStyle {
    bool heat = true;        ///< the value in the colours of the heat map; else the vertices' own colours
    bool iso_lines = false;  ///< a line at every tenth of the value
    float opacity = 0.6f;    ///< [0, 1]
};

/// The heat map's colours, evenly from value 0 to 1 (matplotlib's plasma): readable without colour vision.
inline constexpr std::array<Colour, 4> heat_colours{
    {{0x0d, 0x08, 0x87}, {0x9c, 0x17, 0x9e}, {0xed, 0x79, 0x53}, {0xf0, 0xf9, 0x21}}};

class Renderer {
  public:
    /// Needs a loaded context, which must outlive it. What draws throws Error where a shader does not
    /// compile.
    Renderer();

    void set_picture(PictureTexture picture);
    /// Whether the picture is, everywhere.
    bool is_opaque() const { return picture_.opaque; }
    /// still: what is drawn under the mesh where this is drawn, and never moves
    void set_mesh(std::shared_ptr<const Mesh> mesh, const StillCells& still = {});
    /// The mesh as the processor deformed it. now: #vertices of the mesh, image pixels. Where it has not
    /// `moved`, all of the picture is drawn as it is, with the cells that the mesh leaves out.
    void set_positions(std::span<const glm::vec2> now, bool moved);
    /// Has the vertex shader deform the mesh by DLB instead: by these weights, until the next ones or the
    /// next mesh, in this pose. Shapes as deform_dlb's; no weights lets go of the last ones. Throws Error
    /// where the driver has no buffer that large.
    void set_weights(std::span<const float> weights);
    void set_pose(std::span<const DualComplex<float>> transformations, glm::vec2 centre);

    /// Has draw, where it is asked to, lay a colour over the picture wherever there is some of it, until it
    /// is set empty. vertices: #vertices of the mesh, or none
    void set_overlay(std::span<const OverlayVertex> vertices, const OverlayStyle& style = {});

    /// Draws the deformed picture as weighted colours, samples x samples texels a target pixel. What is left
    /// of first_column, target pixels, stays as it was.
    void draw(const View& view, int samples, bool with_overlay = false, int first_column = 0,
              Fineness fineness = Fineness::all);

    /// Turns what draw drew into straight-alpha integers, filled with `background` or as transparent as it
    /// is, and writes them at (left, top) of `image`, whose depth they take.
    void read_back(Image& image, int left, int top, const View& view, int samples,
                   std::optional<Colour> background);

    /// Shows what draw drew with one sample a pixel: over a checkerboard of squares of `square` pixels inside
    /// the image's frame, dimmed beside it; with the mesh's lines and its folded triangles where asked.
    /// first_column: as draw's. Returns the texture that holds it.
    GLuint display(const View& view, const DisplayColours& colours, double square, const ShownMesh& mesh = {},
                   int first_column = 0);

    /// Bytes of the mesh that were handed to the driver so far: for tests.
    std::size_t uploaded() const { return mesh_.uploaded(); }
    /// The mesh's triangles that were drawn the last time: likewise.
    std::size_t drawn() const { return mesh_.drawn(); }

  private:
    void set_view(const GlProgram& program, const View& view, int samples) const;
    void use_mesh_program(const View& view, int samples, bool with_overlay);
    void draw_picture();
    void draw_still();
    void resolve(const View& view, bool deep, int samples, std::optional<Colour> background);
    void read_integers(Image& image, int left, int top, const View& view);
    void draw_lines(const View& view, glm::vec4 colour);
    void draw_folds(const View& view, double hatching);

    LazyProgram mesh_program_, mesh_overlay_program_, resolve_program_, display_program_, lines_program_,
        folds_program_;
    GlVertexArray picture_array_, empty_array_, still_array_;
    GlBuffer picture_corners_, still_corners_, still_triangles_;
    GLsizei still_count_ = 0;  ///< indices
    DrawnMesh mesh_;
    bool moved_ = false;
    std::optional<OverlayStyle> overlay_style_;  ///< set where there is an overlay
    PictureTexture picture_;
    Target layer_, integers_, shown_;
};

}  // namespace probewarp

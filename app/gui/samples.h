// The sample pictures and projects, as thumbnails of the empty window.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "render/gl_objects.h"

namespace probewarp {

struct App;

struct Sample {
    std::filesystem::path path;
    std::string title;
    int width = 0, height = 0;  ///< of the thumbnail, pixels
    GlTexture texture;          ///< once it is loaded
};

struct Samples {
    std::vector<Sample> list;
    bool begun = false;
};

/// Where the samples are: beside an installed program, or in the checkout it was built in. May not exist.
std::filesystem::path samples_folder();

/// What the canvas shows before a picture is open: an invitation, a button, the samples.
void draw_empty_state(App& app, float left, float top, float width, float height);

}  // namespace probewarp

// Recomputes vertices and pixels of the program's output in double precision, from the papers and the
// conventions alone. It shares no code with core/: rigid motions are unit dual quaternions here (rotation
// about z), the mesh is indexed on the fly, the pictures are read by libspng directly.
#include <gtest/gtest.h>
#include <spng.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Pixel = std::array<double, 4>;

struct Picture {
    int w = 0, h = 0;
    std::vector<Pixel> p;  // row by row; RGBA from 0 to 1
    const Pixel& at(int x, int y) const {
        return p[std::size_t(std::clamp(y, 0, h - 1)) * std::size_t(w) +
                 std::size_t(std::clamp(x, 0, w - 1))];
    }
};

struct Point {
    double x, y;
};

struct Handle {  // a probe as it is typed on the command line
    double rx, ry, x, y, degrees, radius;
};

Picture read_png(const std::string& path) {
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (!file) throw std::runtime_error("no file " + path);
    spng_ctx* png = spng_ctx_new(0);
    spng_set_png_file(png, file);
    spng_ihdr header{};
    spng_get_ihdr(png, &header);
    std::vector<std::uint8_t> bytes(std::size_t(header.width) * header.height * 4);
    const int error = spng_decode_image(png, bytes.data(), bytes.size(), SPNG_FMT_RGBA8, SPNG_DECODE_TRNS);
    spng_ctx_free(png);
    std::fclose(file);
    if (error) throw std::runtime_error(spng_strerror(error));
    Picture picture{int(header.width), int(header.height), {}};
    for (std::size_t i = 0; i < bytes.size(); i += 4)
        picture.p.push_back(
            {bytes[i] / 255.0, bytes[i + 1] / 255.0, bytes[i + 2] / 255.0, bytes[i + 3] / 255.0});
    return picture;
}

/// A black PNG of that size, for deformations that only the mesh is looked at of.
void write_png(const std::string& path, int w, int h) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    spng_ctx* png = spng_ctx_new(SPNG_CTX_ENCODER);
    spng_set_png_file(png, file);
    spng_ihdr header{std::uint32_t(w), std::uint32_t(h), 8, SPNG_COLOR_TYPE_GRAYSCALE, 0, 0, 0};
    spng_set_ihdr(png, &header);
    const std::vector<std::uint8_t> zeros(std::size_t(w) * std::size_t(h));
    spng_encode_image(png, zeros.data(), zeros.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
    spng_ctx_free(png);
    std::fclose(file);
}

/// Where the blend of the probes takes a point: unit dual quaternions (cos t/2 + k sin t/2) + e/2 d q, after
/// Kavan, weighted by radius^2 / distance^2, about the picture's centre.
Point deformed(Point v, const std::vector<Handle>& probes, double cx, double cy) {
    double w = 0, z = 0, ex = 0, ey = 0;  // real part w + z k; dual part ex i + ey j
    for (const Handle& p : probes) {
        const double dx = v.x - p.rx, dy = v.y - p.ry, d2 = dx * dx + dy * dy;
        double weight = p.radius * p.radius / d2;
        if (d2 == 0) {  // a probe on the point has all the weight
            bool first = true;
            for (const Handle& q : probes)
                if (&q < &p && q.rx == p.rx && q.ry == p.ry) first = false;
            if (first) w = z = ex = ey = 0;
            weight = 1;
        } else if (std::any_of(probes.begin(), probes.end(),
                               [&](const Handle& q) { return q.rx == v.x && q.ry == v.y; })) {
            weight = 0;
        }
        const double t = p.degrees * std::numbers::pi / 180, c = std::cos(t / 2), s = std::sin(t / 2);
        // turn about rest, then rest to now: x -> R (x - rest) + now, in the frame about the centre
        const double rx = p.rx - cx, ry = p.ry - cy, nx = p.x - cx, ny = p.y - cy;
        const double tx = nx - (std::cos(t) * rx - std::sin(t) * ry),
                     ty = ny - (std::sin(t) * rx + std::cos(t) * ry);
        // e/2 (tx i + ty j)(c + s k): i k = -j, j k = i
        w += weight * c;
        z += weight * s;
        ex += weight * 0.5 * (tx * c + ty * s);
        ey += weight * 0.5 * (ty * c - tx * s);
    }
    const double n = w * w + z * z;
    const double cs = (w * w - z * z) / n, sn = 2 * w * z / n;
    // translation 2 dual real* / n: (ex i + ey j)(w - z k) = (ex w - ey z) i + (ey w + ex z) j
    const double tx = 2 * (ex * w - ey * z) / n, ty = 2 * (ey * w + ex * z) / n;
    const double x = v.x - cx, y = v.y - cy;
    return {cs * x - sn * y + tx + cx, sn * x + cs * y + ty + cy};
}

std::string text_of(const std::vector<Handle>& probes) {
    std::ostringstream out;
    out.precision(17);
    for (const Handle& p : probes)
        out << " --probe " << p.rx << ',' << p.ry << ':' << p.x << ',' << p.y << ',' << p.degrees << ','
            << p.radius;
    return out.str();
}

std::string scratch(const std::string& name) {
    const char* set =
        std::getenv("PROBEWARP_INSTRUCTION_SET");  // the same test may run under several at once
    const auto folder =
        std::filesystem::path(PROBEWARP_SCRATCH) / (set && *set != 0 ? set : "widest") /
        (std::string("check.") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder);
    return (folder / name).string();
}

void run(const std::string& arguments) {
    const std::string command = std::string("'") + PROBEWARP_PROGRAM + "' render " + arguments;
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

std::vector<Handle> random_probes(std::mt19937_64& random, int count, double w, double h, double wander,
                                  double turn) {
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Handle> probes;
    for (int i = 0; i < count; ++i) {
        const double x = unit(random) * w, y = unit(random) * h;
        probes.push_back({x, y, x + (unit(random) - 0.5) * wander, y + (unit(random) - 0.5) * wander,
                          (unit(random) - 0.5) * turn, 10 + 90 * unit(random)});
    }
    return probes;
}

/// The largest distance of the OBJ's vertices from where they must be, pixels: the grid's, then one for each
/// probe that is on no vertex of the grid, which goes where the probe goes.
double worst_vertex(const std::string& obj, int w, int h, int columns, int rows,
                    const std::vector<Handle>& probes) {
    std::ifstream in(obj);
    double worst = 0;
    std::size_t seen = 0;
    for (std::string line; std::getline(in, line);) {
        double x = 0, y = 0, z = 0;
        if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) != 3) continue;
        y = h - y;  // OBJ has y up
        if (seen >= std::size_t(columns + 1) * std::size_t(rows + 1)) {
            double nearest = 1e9;
            for (const Handle& p : probes) nearest = std::min(nearest, std::hypot(x - p.x, y - p.y));
            worst = std::max(worst, nearest);
            ++seen;
            continue;
        }
        const auto column = int(seen % std::size_t(columns + 1)), row = int(seen / std::size_t(columns + 1));
        // The rest position as the program holds it, a float: the probe's place on a vertex must be seen
        // alike.
        const Point rest{double(float(double(w) * column / columns)), double(float(double(h) * row / rows))};
        const Point expected = deformed(rest, probes, w / 2.0, h / 2.0);
        worst = std::max(worst, std::hypot(x - expected.x, y - expected.y));
        ++seen;
    }
    std::size_t beside = 0;  // probes on no crossing of the grid
    for (const Handle& p : probes) {
        const double c = p.rx * columns / w, r = p.ry * rows / h;
        beside += std::abs(c - std::round(c)) > 1e-4 || std::abs(r - std::round(r)) > 1e-4;
    }
    EXPECT_EQ(seen, std::size_t(columns + 1) * std::size_t(rows + 1) + beside);
    return worst;
}

TEST(Vertices, AreWithinAHundredthOfAPixelAt8192) {
    constexpr unsigned seed = 20261121;
    std::printf("seed %u\n", seed);
    std::mt19937_64 random(seed);
    write_png(scratch("large.png"), 8192, 6144);
    for (const int count : {1, 2, 7, 40}) {
        // Turns up to 150 degrees either way: opposite half angles nearly cancel and have no accurate answer.
        const auto probes = random_probes(random, count, 8192, 6144, 3000, 300);
        run(scratch("large.png") + " -o " + scratch("mesh.obj") + text_of(probes));
        EXPECT_LT(worst_vertex(scratch("mesh.obj"), 8192, 6144, 100, 75, probes), 0.01) << count << " probes";
    }
}

TEST(Vertices, FollowProbesOnThem) {
    write_png(scratch("small.png"), 100, 50);
    const std::vector<Handle> probes{
        {10, 10, 20, 15, 30, 40}, {90, 40, 90, 40, 0, 40}, {50, 25, 45, 20, 720, 20}};
    run(scratch("small.png") + " -o " + scratch("mesh.obj") + text_of(probes));
    EXPECT_LT(worst_vertex(scratch("mesh.obj"), 100, 50, 100, 50, probes), 1e-4);
}

/// Alpha-weighted halving, as a mipmap is defined.
std::vector<Picture> mipmaps(Picture level) {
    std::vector<Picture> all{level};
    while (level.w > 1 || level.h > 1) {
        Picture half{std::max(1, level.w / 2), std::max(1, level.h / 2), {}};
        for (int y = 0; y < half.h; ++y)
            for (int x = 0; x < half.w; ++x) {
                Pixel sum{}, plain{};
                for (const auto& [px, py] : {std::pair{2 * x, 2 * y},
                                             {2 * x + 1, 2 * y},
                                             {2 * x, 2 * y + 1},
                                             {2 * x + 1, 2 * y + 1}}) {
                    const Pixel& p = level.at(px, py);
                    for (std::size_t k = 0; k < 3; ++k) sum[k] += p[k] * p[3], plain[k] += p[k] / 4;
                    sum[3] += p[3];
                }
                Pixel q{plain[0], plain[1], plain[2], sum[3] / 4};
                for (std::size_t k = 0; k < 3 && sum[3] > 0; ++k) q[k] = sum[k] / sum[3];
                half.p.push_back(q);
            }
        all.push_back(half);
        level = std::move(half);
    }
    return all;
}

/// Bilinear and weighted by alpha: colour times alpha, alpha.
Pixel sampled(const Picture& picture, double x, double y) {
    const double px = x - 0.5, py = y - 0.5, fx = px - std::floor(px), fy = py - std::floor(py);
    const int ix = int(std::floor(px)), iy = int(std::floor(py));
    Pixel sum{};
    for (const auto& [dx, dy, w] : {std::tuple{0, 0, (1 - fx) * (1 - fy)},
                                    {1, 0, fx * (1 - fy)},
                                    {0, 1, (1 - fx) * fy},
                                    {1, 1, fx * fy}}) {
        const Pixel& p = picture.at(ix + dx, iy + dy);
        for (std::size_t k = 0; k < 3; ++k) sum[k] += w * p[3] * p[k];
        sum[3] += w * p[3];
    }
    return sum;
}

struct Triangle {
    std::array<Point, 3> rest, now;
};

using Corners = std::array<Point, 3>;

/// Cuts the triangles of a cell in or on the edge of which a probe lies from there to their corners.
void cut(std::vector<Corners>& cell, Point p) {
    const std::size_t count = cell.size();
    for (std::size_t t = 0; t < count; ++t) {
        const Corners old = cell[t];
        const auto side = [&](const Point& a, const Point& b) {
            return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        };
        const auto [a, b, c] = old;
        const std::array<double, 3> sides{side(b, c), side(c, a), side(a, b)};
        // Anticlockwise as seen, y down.
        if (*std::max_element(sides.begin(), sides.end()) > 0) continue;
        std::vector<Corners> parts;
        for (std::size_t k = 0; k < 3; ++k)
            if (sides[k] < 0) parts.push_back({old[(k + 1) % 3], old[(k + 2) % 3], p});
        if (parts.size() < 2) continue;  // on a corner
        cell[t] = parts[0];
        cell.insert(cell.end(), parts.begin() + 1, parts.end());
    }
}

/// Every triangle of the deformed grid, in drawing order: the cells row by row, the upper right half first.
std::vector<Triangle> triangles(int w, int h, int columns, int rows, const std::vector<Handle>& probes) {
    const auto corner = [&](int c, int r) { return Point{double(w) * c / columns, double(h) * r / rows}; };
    std::vector<Triangle> all;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            std::vector<Corners> cell{{corner(c, r), corner(c + 1, r + 1), corner(c + 1, r)},
                                      {corner(c, r), corner(c, r + 1), corner(c + 1, r + 1)}};
            for (const Handle& p : probes) cut(cell, {p.rx, p.ry});
            for (const Corners& rest : cell) {
                Triangle t{rest, {}};
                for (std::size_t k = 0; k < 3; ++k) t.now[k] = deformed(rest[k], probes, w / 2.0, h / 2.0);
                all.push_back(t);
            }
        }
    return all;
}

struct Rendered {
    Pixel pixel{};          // straight
    bool doubtful = false;  // so near an edge that rounding decides
};

/// The pixel centre at (x, y) of the deformed picture, composited over what was drawn before.
Rendered rendered(const std::vector<Triangle>& mesh, const std::vector<Picture>& levels, double x, double y) {
    Rendered result;
    Pixel sum{};
    for (const Triangle& t : mesh) {
        const auto& [a, b, c] = t.now;
        if (std::max({a.x, b.x, c.x}) < x - 1 || std::min({a.x, b.x, c.x}) > x + 1 ||
            std::max({a.y, b.y, c.y}) < y - 1 || std::min({a.y, b.y, c.y}) > y + 1)
            continue;
        const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        const double u = ((b.x - x) * (c.y - y) - (b.y - y) * (c.x - x)) / area;
        const double v = ((c.x - x) * (a.y - y) - (c.y - y) * (a.x - x)) / area;
        const std::array<double, 3> bary{u, v, 1 - u - v};
        const double least = std::min({bary[0], bary[1], bary[2]});
        if (std::abs(least) < 0.02) result.doubtful = true;  // neighbours agree on colour there, not on folds
        if (least < 0) continue;
        Point rest{0, 0};
        for (std::size_t k = 0; k < 3; ++k) rest.x += bary[k] * t.rest[k].x, rest.y += bary[k] * t.rest[k].y;
        // How the place at rest changes from pixel to pixel: the triangle's affine map, inverted.
        const auto slope = [&](double Point::*of, bool across) {
            const double f1 = t.rest[1].*of - t.rest[0].*of, f2 = t.rest[2].*of - t.rest[0].*of;
            return across ? (f1 * (c.y - a.y) - f2 * (b.y - a.y)) / area
                          : (f2 * (b.x - a.x) - f1 * (c.x - a.x)) / area;
        };
        const double footprint = std::max(std::hypot(slope(&Point::x, true), slope(&Point::y, true)),
                                          std::hypot(slope(&Point::x, false), slope(&Point::y, false)));
        const double level = footprint < 1.02 ? 0 : std::min(std::log2(footprint), double(levels.size() - 1));
        if (std::abs(footprint - 1.02) < 0.005) result.doubtful = true;
        const auto fine = std::size_t(level);
        const double part = level - double(fine);
        Pixel colour =
            sampled(levels[fine], rest.x / std::exp2(double(fine)), rest.y / std::exp2(double(fine)));
        if (part > 0 && fine + 1 < levels.size()) {
            const double shrink = std::exp2(double(fine + 1));
            const Pixel coarse = sampled(levels[fine + 1], rest.x / shrink, rest.y / shrink);
            for (std::size_t k = 0; k < 4; ++k) colour[k] += part * (coarse[k] - colour[k]);
        }
        for (std::size_t k = 0; k < 4; ++k) sum[k] = colour[k] + (1 - colour[3]) * sum[k];
    }
    result.pixel = sum;
    for (std::size_t k = 0; k < 3 && sum[3] > 0; ++k) result.pixel[k] = sum[k] / sum[3];
    return result;
}

void check_pixels(const std::string& input, int cells_x, int cells_y, const std::vector<Handle>& probes,
                  const std::string& backend) {
    const std::string path = std::string(PROBEWARP_INPUTS) + "/" + input, output = scratch(input);
    run(path + " -o " + output + " --mesh " + std::to_string(std::max(cells_x, cells_y)) + " --backend " +
        backend + text_of(probes));
    const Picture in = read_png(path), out = read_png(output);
    const auto mesh = triangles(in.w, in.h, cells_x, cells_y, probes);
    const auto levels = mipmaps(in);
    int judged = 0, wrong = 0;
    for (int y = 0; y < out.h; ++y)
        for (int x = 0; x < out.w; ++x) {
            const Rendered expected = rendered(mesh, levels, x + 0.5, y + 0.5);
            if (expected.doubtful) continue;
            ++judged;
            // One level for rounding, one for texels and mipmaps kept in 8 bits; a colour that is hardly
            // there has no more digits than its alpha.
            const double alpha = std::max(expected.pixel[3], 1e-3), allowed = 2.0 / 255;
            bool off = std::abs(out.at(x, y)[3] - expected.pixel[3]) > allowed;
            for (std::size_t k = 0; k < 3 && expected.pixel[3] > 0.5 / 255; ++k)
                off = off || std::abs(out.at(x, y)[k] - expected.pixel[k]) > allowed + 0.5 / 255 / alpha;
            if (off && ++wrong <= 5)
                ADD_FAILURE() << input << " at " << x << ", " << y << ": got " << out.at(x, y)[0] * 255 << ' '
                              << out.at(x, y)[3] * 255 << ", expected " << expected.pixel[0] * 255 << ' '
                              << expected.pixel[3] * 255;
        }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(judged, out.w * out.h / 4);  // or the check would say nothing
}

/// What draws: the processor, which is the default, and two drivers.
class Pixels : public testing::TestWithParam<const char*> {};

TEST_P(Pixels, OfAGentleDeformation) {
    check_pixels("card.png", 12, 12,
                 {{20, 20, 26, 17, 25, 30}, {70, 30, 66, 38, -15, 25}, {48, 80, 48, 80, 0, 40}}, GetParam());
}
TEST_P(Pixels, OfATurnBesideOneThatStays) {
    check_pixels("card.png", 12, 12, {{30, 30, 40, 28, 45, 30}, {70, 70, 70, 70, -20, 25}}, GetParam());
}
TEST_P(Pixels, OfSoftEdges) {
    check_pixels("soft.png", 8, 8, {{20, 32, 14, 28, -30, 20}, {46, 32, 52, 40, 35, 20}}, GetParam());
}
TEST_P(Pixels, OfAFold) {
    check_pixels("soft.png", 8, 8, {{16, 32, 46, 30, 10, 20}, {48, 32, 20, 34, -10, 20}}, GetParam());
}
TEST_P(Pixels, OfAWidePicture) {
    check_pixels("wide.png", 55, 2,
                 {{900, 20, 910, 16, 6, 100}, {1024, 20, 1018, 24, -8, 100}, {200, 20, 200, 20, 0, 100}},
                 GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, Pixels, testing::Values("auto", "osmesa", "egl"),
                         [](const auto& p) { return std::string(p.param); });

}  // namespace

// `probewarp render --image A B C`: many pictures under the same probes. Pictures are decoded, encoded and
// written by all cores, while one after the other is drawn; one that fails stops no other.
#include "cli/render_many.h"

#include <fmt/format.h>
#include <tbb/info.h>
#include <tbb/task_group.h>

#include <map>
#include <new>
#include <optional>
#include <span>

#include "cli/arguments.h"
#include "cli/printing.h"
#include "cli/report.h"
#include "io/file.h"

namespace probewarp {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view placeholder = "{name}";

fs::path output_of(const std::string& output, const fs::path& image) {
    const std::string name = image.stem().string();
    std::string path = output;
    for (std::size_t at = 0; (at = path.find(placeholder, at)) != std::string::npos; at += name.size())
        path.replace(at, placeholder.size(), name);
    return path;
}

/// One picture, from its file to the other file. What goes wrong on the way is kept in `error`.
struct Work {
    std::string image;
    fs::path output;
    Document document;
    std::optional<Output> file;
    std::unique_ptr<ImageEncoding> encoding;
    std::string error;
    std::string report;    ///< where it is asked for
    tbb::task_group task;  ///< the decoding, later the writing

    void keep_error(const std::function<void()>& step) {
        if (!error.empty()) return;
        try {
            step();
        } catch (const std::bad_alloc&) {
            error = fmt::format("{}: needs more memory than there is; expected a smaller picture", image);
        } catch (const IncompleteFile& e) {
            keep_error_named(with_salvage_hint(e));
        } catch (const std::exception& e) {
            keep_error_named(e.what());
        }
    }

  private:
    void keep_error_named(std::string sentence) {
        error = std::move(sentence);
        if (error.find(image) == std::string::npos && error.find(output.string()) == std::string::npos)
            error = fmt::format("{}: {}", image, error);
    }
};

/// The pictures under way: at most as many as there are cores, and two so that reading and drawing overlap.
class Batch {
  public:
    Batch(const RenderPlan& plan, std::span<const fs::path> outputs, const Document& base,
          const PoseOn& pose_on, Timings& timings)
        : plan_(plan), base_(base), pose_on_(pose_on), timings_(timings), drawer_(plan) {
        for (std::size_t i = 0; i < outputs.size(); ++i) {
            works_.push_back(std::make_unique<Work>());
            works_.back()->image = plan.options.images[i];
            works_.back()->output = outputs[i];
        }
    }

    /// Returns how many failed.
    std::size_t run() {
        const std::size_t at_once = std::max<std::size_t>(2, std::size_t(tbb::info::default_concurrency()));
        for (std::size_t i = 0; i < works_.size(); ++i) {
            for (; begun_ < std::min(i + at_once, works_.size()); ++begun_) {
                if (begun_ >= at_once) retire(begun_ - at_once);
                begin(*works_[begun_]);
            }
            draw(*works_[i], i);
        }
        while (retired_ < works_.size()) retire(retired_);
        return failed_;
    }

  private:
    void begin(Work& work) {
        work.task.run([this, &work] {
            work.keep_error([&] {
                timings_.measure(Stage::decode, [&] {
                    work.document =
                        pose_on_(base_, std::make_shared<Picture>(read_picture(
                                            work.image, Pixels::whole, {.salvage = plan_.options.salvage})));
                });
            });
        });
    }

    void draw(Work& work, std::size_t index) {
        work.task.wait();
        work.keep_error([&] {
            timings_.measure(Stage::weights, [&] { deform(work.document); });
            work.file.emplace(work.output, timings_);
            work.encoding = timings_.measure(Stage::draw, [&] {
                return drawer_.draw(deformation_, *work.file, [&](double part) {
                    progress_.show((double(index) + part) / double(works_.size()));
                });
            });
            if (plan_.options.report) {
                const View view = export_view(deformation_, plan_.file.settings);
                work.report = report_of(work.output, plan_.format, deformation_, &view);
            }
        });
        work.document = {};
        work.task.run([this, &work] {
            work.keep_error([&] {
                work.file->write(timings_.measure(Stage::encode, [&] { return work.encoding->finish(); }));
                work.file->finish();
            });
            work.encoding.reset();
            work.file.reset();
        });
    }

    void deform(const Document& document) {
        if (auto carried = carried_over(deformation_.binding, document))
            pose(deformation_, document, std::move(carried));
        else
            update(deformation_, document);
    }

    /// In their order, so that the sentences come in it too.
    void retire(std::size_t index) {
        Work& work = *works_[index];
        work.task.wait();
        retired_ = index + 1;
        if (work.error.empty()) {
            if (plan_.options.report) print("{}\n", work.report);
            return;
        }
        ++failed_;
        progress_.clear();
        print_failure(work.error);
    }

    const RenderPlan& plan_;
    const Document& base_;
    const PoseOn& pose_on_;
    Timings& timings_;
    Progress progress_{plan_.options.quiet};
    Drawer drawer_;
    Deformation deformation_;
    std::size_t begun_ = 0, retired_ = 0, failed_ = 0;
    std::vector<std::unique_ptr<Work>> works_;  // last in, first out: their tasks end before the drawer does
};

}  // namespace

bool is_many(const RenderOptions& o) {
    return o.output.find(placeholder) != std::string::npos && !o.images.empty();
}

std::vector<fs::path> output_paths(const RenderOptions& o) {
    std::vector<fs::path> paths;
    std::map<fs::path, std::string> taken;  // by whom
    for (const std::string& image : o.images) {
        paths.push_back(output_of(o.output, image));
        const auto [other, fresh] = taken.emplace(paths.back().lexically_normal(), image);
        if (!fresh)
            throw UsageError(
                fmt::format("--image {} and {}: both would be written to {}; expected pictures "
                            "of different names",
                            other->second, image, paths.back().string()));
    }
    return paths;
}

int render_many(const RenderPlan& plan, const Document& base, const PoseOn& pose_on, Timings& timings) {
    const std::vector<fs::path> outputs = output_paths(plan.options);
    for (const fs::path& output : outputs)
        if (output.has_parent_path()) make_folder(output.parent_path());
    return Batch(plan, outputs, base, pose_on, timings).run() == 0 ? 0 : 1;
}

}  // namespace probewarp

#include "gui/actions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "gui/app.h"
#include "io/file.h"
#include "io/image_file.h"
#include "io/obj.h"
#include "io/printable.h"
#include "io/probes_csv.h"
#include "io/project.h"
#include "io/same_file.h"

namespace probewarp {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> picture_endings() {
    std::vector<std::string> endings;
    for (const ImageFormat& format : image_formats())
        endings.insert(endings.end(), format.extensions.begin(), format.extensions.end());
    return endings;
}

/// Whether the path is one of the files, by whatever name.
bool leads_to_any(const fs::path& path, const std::vector<fs::path>& files) {
    return std::any_of(files.begin(), files.end(),
                       [&](const fs::path& file) { return !file.empty() && is_same_file(path, file); });
}

bool is_sample(const fs::path& path) { return path.parent_path() == samples_folder(); }

/// Where a dialog begins: beside the project or the picture, else where a file was last chosen, else at home.
fs::path usual_folder(const App& app) {
    if (!app.editor.path.empty()) return app.editor.path.parent_path();
    // Beside a sample nobody wants to save.
    if (!app.pictures_read.empty() && !is_sample(app.pictures_read.back()))
        return app.pictures_read.back().parent_path();
    if (!app.last_folder.empty()) return app.last_folder;
    const char* home = std::getenv("HOME");
    return home ? home : "/";
}

/// Ends a job in which a file turned out to be damaged at its end: asks whether to open what is there of it.
std::function<void(App&)> offer_salvage(const fs::path& path, const std::string& what,
                                        std::function<void(App&)> salvage) {
    return [path, what, salvage = std::move(salvage)](App& app) {
        app.questions.push_back(
            {fmt::format("{} is not whole", path.filename().string()),
             fmt::format("{}. What is there of it can be opened: what is missing is clear or black. The file "
                         "itself stays as it is.",
                         what),
             {{"Open what is there", salvage}, {"Cancel", {}}},
             1});
    };
}

/// What became of the files that were dropped with one; `beginning`: "Opened a.png; ".
void say_others(App& app, const std::string& beginning, std::size_t others) {
    if (others == 0) return;
    say(app, Tone::hint,
        fmt::format("{}{} not opened: Probewarp opens one at a time.", beginning,
                    others == 1 ? std::string("1 other was") : fmt::format("{} others were", others)));
}

/// Takes the document that was read from `whole`, unless the driver cannot show it.
void begin_with(App& app, Document& document, const fs::path& whole) {
    try {
        check_texture_size(document.picture->image);
    } catch (const Error& error) {
        return say(app, Tone::error, fmt::format("{}: {}", whole.string(), error.what()));
    }
    // A sample is saved under another name, never over the one that came with the program.
    const bool own = is_project_path(whole) && !is_sample(whole);
    start(app.editor, std::move(document), own ? whole : fs::path(), true);
    app.pictures_read = own ? std::vector<fs::path>() : std::vector{whole};
    app.export_dialog.path = {};
}

void open_now(App& app, const fs::path& path, std::size_t others = 0, DecodeOptions options = {}) {
    start_job(app, fmt::format("Opening {}", path.filename().string()), JobKind::reading,
              [path, others, options](Job&) -> std::function<void(App&)> {
                  try {
                      auto document = std::make_shared<Document>(read_document(path, Pixels::whole, options));
                      std::error_code ignored;
                      const fs::path whole = fs::weakly_canonical(fs::absolute(path, ignored), ignored);
                      return [document, whole, others](App& a) {
                          begin_with(a, *document, whole);
                          say_others(a, fmt::format("Opened {}; ", whole.filename().string()), others);
                      };
                  } catch (const IncompleteFile& error) {
                      return offer_salvage(path, error.what(), [path, others](App& a) {
                          open_now(a, path, others, {.salvage = true});
                      });
                  } catch (const Error& error) {
                      return [what = std::string(error.what()), others](App& a) {
                          say(a, Tone::error, what);
                          say_others(a, "", others);
                      };
                  }
              });
}

void save_to(App& app, fs::path path, std::function<void(App&)> then) {
    if (leads_to_any(path, app.pictures_read))
        return say(app, Tone::error,
                   fmt::format("{} was not saved: it is the file that is open here. Choose another name.",
                               path.filename().string()));
    for (const auto& job : app.jobs.running)
        if (job->kind == JobKind::writing && !job->given_up)
            return say(app, Tone::hint, "The last file is still being written.");
    const unsigned long opened = app.editor.opened;
    const Document document = app.editor.document;
    const std::size_t step = app.editor.history.at;
    start_job(app, fmt::format("Saving {}", path.filename().string()), JobKind::writing,
              [document, path, step, opened, then = std::move(then)](Job& job) -> std::function<void(App&)> {
                  const auto bytes = encode_project(document);
                  if (job.given_up) return {};
                  write_file(path, bytes);
                  return [path, document, step, then, opened, &job](App& a) {
                      // Given up too late, the person may have gone on, or have opened another document.
                      const auto& steps = a.editor.history.steps;
                      if (a.editor.opened == opened) {
                          a.editor.path = path;
                          if (step < steps.size() && steps[step].document == document)
                              a.editor.history.saved = step;
                      }
                      say(a, Tone::done, fmt::format("Saved {}.", path.filename().string()));
                      if (then && !job.given_up) then(a);
                  };
              });
}

void save_as(App& app, std::function<void(App&)> then = {}) {
    fs::path proposed = app.editor.path;
    if (proposed.empty())
        proposed =
            usual_folder(app) /
            fitting_name(fs::path(app.editor.document.picture->name).stem().string(), project_extension);
    ask_for_file(app, "Save the project", "Save", FileUse::save, {project_extension}, proposed,
                 [then = std::move(then)](App& a, const fs::path& path) { save_to(a, path, then); });
}

void save(App& app, std::function<void(App&)> then = {}) {
    if (app.editor.path.empty())
        save_as(app, std::move(then));
    else
        save_to(app, app.editor.path, std::move(then));
}

void open_dialog(App& app) {
    std::vector<std::string> endings = picture_endings();
    endings.emplace_back(project_extension);
    ask_for_file(app, "Open a picture or a project", "Open", FileUse::open, endings, usual_folder(app),
                 [](App& a, const fs::path& path) { open_now(a, path); });
}

void new_document(App& app) {
    start(app.editor, {}, {}, true);
    app.pictures_read.clear();
    app.export_dialog.path = {};
}

/// Puts the picture that was read from `path` under the probes.
void take_picture(App& app, const std::shared_ptr<const Picture>& picture, const fs::path& path) {
    Document document = app.editor.document;
    replace_picture(document, picture);
    try {
        check_texture_size(picture->image);
        check_size(document);
    } catch (const Error& error) {
        return say(app, Tone::error, fmt::format("{}: {}", path.string(), error.what()));
    }
    app.editor.axis.reset();  // it was the other picture's
    app.editor.document = std::move(document);
    commit(app.editor, "Replace picture");
    app.editor.fit_wanted = true;
    app.pictures_read.push_back(path);
}

void replace_now(App& app, const fs::path& path, DecodeOptions options = {}) {
    start_job(app, fmt::format("Opening {}", path.filename().string()), JobKind::reading,
              [path, options](Job&) -> std::function<void(App&)> {
                  try {
                      auto picture =
                          std::make_shared<const Picture>(read_picture(path, Pixels::whole, options));
                      return [picture, path](App& a) { take_picture(a, picture, path); };
                  } catch (const IncompleteFile& error) {
                      return offer_salvage(path, error.what(),
                                           [path](App& a) { replace_now(a, path, {.salvage = true}); });
                  }
              });
}

void replace_picture_dialog(App& app) {
    ask_for_file(app, "Put another picture under the probes", "Use", FileUse::open, picture_endings(),
                 usual_folder(app), [](App& a, const fs::path& path) { replace_now(a, path); });
}

void import_probes_dialog(App& app) {
    ask_for_file(
        app, "Import the probes of a CSV file", "Import", FileUse::open, {".csv", ".txt"}, usual_folder(app),
        [](App& a, const fs::path& path) {
            try {
                const auto bytes = read_file(path);
                Document document = a.editor.document;
                const auto probes =
                    decode_probes_csv({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, document);
                document.probes.insert(document.probes.end(), probes.begin(), probes.end());
                check_size(document);
                a.editor.document = std::move(document);
                commit(a.editor, "Import probes");
                say(a, Tone::done, fmt::format("Imported {} probes.", probes.size()));
            } catch (const Error& error) {
                const std::string said = error.what(), name = path.string();
                say(a, Tone::error, said.starts_with(name) ? said : fmt::format("{}: {}", name, said));
            }
        });
}

void export_dialog(App& app) {
    ExportDialog& dialog = app.export_dialog;
    dialog.open = true;
    if (!dialog.path.text.empty()) return;
    const fs::path name =
        app.editor.path.empty() ? fs::path(app.editor.document.picture->name).stem() : app.editor.path.stem();
    dialog.path.put(usual_folder(app) / fitting_name(name.string(), "-deformed.png"));
}

void switch_theme(App& app) {
    app.theme = app.theme.is_light ? dark_theme() : light_theme();
    apply_theme(app.theme, app.scale);
}

}  // namespace

std::string document_name(const App& app) {
    if (!app.editor.path.empty()) return printable(app.editor.path.filename().native());
    return has_picture(app.editor) ? printable(app.editor.document.picture->name) : "";
}

bool is_being_read(const App& app, const fs::path& path) {
    return leads_to_any(path, {app.editor.path}) || leads_to_any(path, app.pictures_read);
}

void end_gesture(App& app) {
    if (!app.editor.gesture) return;
    if (app.editor.gesture->kind == Gesture::Kind::field)
        end_field(app.editor, app.field_label);
    else
        cancel(app.editor);
}

void after_saving(App& app, const char* what, std::function<void(App&)> then) {
    end_gesture(app);
    if (!has_picture(app.editor) || is_saved(app.editor.history)) return then(app);
    app.questions.push_back(
        {"Unsaved changes",
         fmt::format("{} has changes that are not saved. Save them before {}?", document_name(app), what),
         {{"Save", [then](App& a) { save(a, then); }}, {"Throw away", then}, {"Cancel", {}}},
         2});
    app.wake();
}

void open_path(App& app, const fs::path& path, std::size_t others) {
    after_saving(app, "opening another", [path, others](App& a) { open_now(a, path, others); });
}

void open_dropped(App& app, std::span<const char* const> dropped) {
    if (dropped.empty()) return;
    const auto path = dropped_path(dropped.front());
    const std::string name = path ? path->filename().string() : dropped.front();
    if (app.modal)
        return say(app, Tone::hint, fmt::format("{} was not opened: answer the dialog first.", name));
    if (!path)
        return say(app, Tone::error,
                   fmt::format("{} was not opened: it is on no disk here. Save it as a file first.", name));
    app.last_folder = path->parent_path();
    open_path(app, *path, dropped.size() - 1);
}

fs::path export_path(const App& app) {
    return usual_folder(app) / without_tilde(app.export_dialog.path.meant().native());
}

namespace {

/// What a job needs of the deformation: without the weights, which may be large.
Deformation shape_of(const Deformation& deformation, const Document& document) {
    Deformation shape;
    shape.binding = deformation.binding;
    shape.now = deformation.now;
    shape.moved = deformation.moved;
    shape.source = document;
    return shape;
}

/// False where it was given up: then nothing was written.
bool write_obj(const Deformation& shape, const fs::path& path, const Job& job) {
    const ObjContents contents = obj_contents(path, shape);
    if (job.given_up) return false;
    write_obj(contents);
    return true;
}

/// False where it was given up: then nothing was written.
bool write_picture(const Deformation& shape, const PictureFile& file, const fs::path& path, Job& job) {
    struct GivenUp {};
    FileWriter output(path);
    const auto write = [&](const FileParts& parts) {
        if (job.given_up) throw GivenUp();
        for (const auto& part : parts) output.write(part);
    };
    const auto show = [&](double part) { job.progress = float(part); };
    try {
        const auto encoding = draw_picture_file(shape, file, {write, [&] { output.restart(); }, show});
        job.progress = -1;  // how long the rest of the file takes nobody knows
        write(encoding->finish());
    } catch (const GivenUp&) {
        return false;
    }
    output.finish();
    return true;
}

std::string exported_sentence(const fs::path& path) {
    if (!is_obj(path)) return fmt::format("Exported {}.", path.string());
    const auto [material, texture] = obj_companions(path);
    return fmt::format("Exported {}, and beside it {} and {}.", path.string(), material.filename().string(),
                       texture.filename().string());
}

}  // namespace

void export_to(App& app, const fs::path& path) {
    PictureFile file{image_format_of(path), app.export_dialog.settings, app.export_dialog.encode};
    file.encode.background = file.settings.background.value_or(file.encode.background);
    start_job(app, fmt::format("Exporting {}", path.filename().string()), JobKind::writing,
              [path, file, shape = shape_of(app.editor.deformation, app.editor.document)](
                  Job& job) -> std::function<void(App&)> {
                  const bool written =
                      is_obj(path) ? write_obj(shape, path, job) : write_picture(shape, file, path, job);
                  if (!written) return {};
                  return [path](App& a) { say(a, Tone::done, exported_sentence(path)); };
              });
}

namespace {

void start_task(App& app, Task task) {
    const std::size_t step = app.editor.history.at;
    start_job(app, task.label, JobKind::reading,
              [task = std::move(task), step, opened = app.editor.opened](Job&) -> std::function<void(App&)> {
                  auto document = std::make_shared<const Document>(task.run());
                  return [document, label = task.label, step, opened](App& a) {
                      if (a.editor.opened != opened || a.editor.history.at != step) return;
                      a.editor.document = *document;
                      commit(a.editor, label);
                  };
              });
}

}  // namespace

void handle_requests(App& app) {
    if (!app.questions.empty()) app.editor.requests.clear();  // one question at a time
    for (const Request request : std::exchange(app.editor.requests, {})) switch (request) {
            case Request::new_document:
                after_saving(app, "closing it", &new_document);
                break;
            case Request::open:
                after_saving(app, "opening another", &open_dialog);
                break;
            case Request::save:
                save(app);
                break;
            case Request::save_as:
                save_as(app);
                break;
            case Request::export_picture:
                export_dialog(app);
                break;
            case Request::import_probes:
                import_probes_dialog(app);
                break;
            case Request::replace_picture:
                replace_picture_dialog(app);
                break;
            case Request::switch_theme:
                switch_theme(app);
                break;
            case Request::levels:
                app.levels_dialog.open = true;
                break;
            case Request::about:
                app.about_open = true;
                break;
            case Request::quit:
                after_saving(app, "leaving", [](App& a) { a.quit = true; });
                break;
        }
    for (Task& task : std::exchange(app.editor.tasks, {})) start_task(app, std::move(task));
    if (!app.editor.notice.empty()) say(app, Tone::hint, std::exchange(app.editor.notice, {}));
}

}  // namespace probewarp

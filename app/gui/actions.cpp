#include "gui/actions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "gui/app.h"
#include "io/file.h"
#include "io/image_file.h"
#include "io/obj.h"
#include "io/probes_csv.h"
#include "io/project.h"

namespace probewarp {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> picture_endings() {
    std::vector<std::string> endings;
    for (const ImageFormat& format : image_formats())
        endings.insert(endings.end(), format.extensions.begin(), format.extensions.end());
    return endings;
}

/// Where a dialog begins: beside the project, or at home.
fs::path usual_folder(const App& app) {
    if (!app.editor.path.empty()) return app.editor.path.parent_path();
    const char* home = std::getenv("HOME");
    return home ? home : "/";
}

void open_now(App& app, const fs::path& path) {
    start_job(app, fmt::format("Opening {}", path.filename().string()), JobKind::reading,
              [path](Job&) -> std::function<void(App&)> {
                  auto document = std::make_shared<Document>(read_document(path));
                  std::error_code ignored;
                  const fs::path whole = fs::weakly_canonical(fs::absolute(path, ignored), ignored);
                  return [document, whole](App& a) {
                      try {
                          check_texture_size(document->picture->image);
                      } catch (const Error& error) {
                          return say(a, Tone::error, fmt::format("{}: {}", whole.string(), error.what()));
                      }
                      const bool project = whole.extension() == project_extension;
                      // A sample is saved under another name, never over the one that came with the program.
                      const bool sample = whole.parent_path() == samples_folder();
                      start(a.editor, std::move(*document), project && !sample ? whole : fs::path(), true);
                      a.export_dialog.path.clear();
                  };
              });
}

void save_to(App& app, fs::path path, std::function<void(App&)> then) {
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
        proposed = usual_folder(app) /
                   fs::path(app.editor.document.picture->name).replace_extension(project_extension);
    ask_for_file(app, "Save the project", "Save", true, {project_extension}, proposed,
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
    ask_for_file(app, "Open a picture or a project", "Open", false, endings, usual_folder(app),
                 [](App& a, const fs::path& path) { open_now(a, path); });
}

void new_document(App& app) {
    start(app.editor, {}, {}, true);
    app.export_dialog.path.clear();
}

void replace_picture_dialog(App& app) {
    ask_for_file(app, "Put another picture under the probes", "Replace", false, picture_endings(),
                 usual_folder(app), [](App& app_now, const fs::path& path) {
                     start_job(app_now, fmt::format("Opening {}", path.filename().string()), JobKind::reading,
                               [path](Job&) -> std::function<void(App&)> {
                                   auto picture = std::make_shared<const Picture>(read_picture(path));
                                   return [picture](App& a) {
                                       Document document = a.editor.document;
                                       replace_picture(document, picture);
                                       try {
                                           check_texture_size(picture->image);
                                           check_size(document);
                                       } catch (const Error& error) {
                                           return say(a, Tone::error, error.what());
                                       }
                                       a.editor.axis.reset();  // it was the other picture's
                                       a.editor.document = std::move(document);
                                       commit(a.editor, "Replace picture");
                                       a.editor.fit_wanted = true;
                                   };
                               });
                 });
}

void import_probes_dialog(App& app) {
    ask_for_file(
        app, "Import the probes of a CSV file", "Import", false, {".csv", ".txt"}, usual_folder(app),
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
    dialog.overwrite_asked = false;
    if (dialog.path.empty()) {
        const fs::path name = fs::path(document_name(app)).stem();
        dialog.path = (usual_folder(app) / (name.string() + "-deformed.png")).string();
    }
}

void switch_theme(App& app) {
    app.theme = app.theme.is_light ? dark_theme() : light_theme();
    apply_theme(app.theme, app.scale);
}

}  // namespace

std::string document_name(const App& app) {
    if (!app.editor.path.empty()) return app.editor.path.filename().string();
    return has_picture(app.editor) ? app.editor.document.picture->name : "";
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
         {{"Save", [then](App& a) { save(a, then); }}, {"Throw away", then}, {"Cancel", {}}}});
    app.wake();
}

void open_path(App& app, const fs::path& path) {
    after_saving(app, "opening another", [path](App& a) { open_now(a, path); });
}

bool is_obj(const fs::path& path) { return path.extension() == ".obj" || path.extension() == ".OBJ"; }

fs::path export_path(const App& app) {
    const std::string& typed = app.export_dialog.path;
    const char* home = std::getenv("HOME");
    if (home && typed.starts_with("~/")) return fs::path(home) / typed.substr(2);
    return usual_folder(app) / typed;
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

/// Likewise.
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

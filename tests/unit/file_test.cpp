// Reading and writing whole files: what is refused, and that a failed save leaves the old file alone.
#include "io/file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <fstream>

#include "io/same_file.h"
#include "io/temporary_file.h"
#include "pictures.h"
#include "temporary_folder.h"

namespace probewarp {
namespace {

namespace fs = std::filesystem;
using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFolder;

std::vector<std::byte> bytes_of(std::string_view text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return {first, first + text.size()};
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

mode_t mode_of(const fs::path& path) {
    struct stat status {};
    EXPECT_EQ(::stat(path.c_str(), &status), 0);
    return status.st_mode & 07777;
}

struct FileTest : ::testing::Test {
    TemporaryFolder folder;
    fs::path path = folder.path / "file";

    void put(std::string_view text) const { std::ofstream(path, std::ios::binary) << text; }
    std::string got() const {
        std::ifstream in(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

TEST_F(FileTest, ReadsWhatWasWritten) {
    std::vector<std::byte> all;
    for (int i = 0; i < 100'000; ++i) all.push_back(std::byte(i * 7 % 256));
    write_file(path, all);
    EXPECT_EQ(read_file(path), all);
}

TEST_F(FileTest, ReadsUpToTheLimitAndNoFurther) {
    put("12345");
    EXPECT_EQ(read_file(path, 5).size(), 5u);
    EXPECT_THAT(error_of([&] { read_file(path, 4); }),
                HasSubstr("file: is 5 bytes long; expected at most 4"));
}

TEST_F(FileTest, RefusesToReadWhatIsNoFile) {
    EXPECT_THAT(error_of([&] { read_file(path); }), HasSubstr("file: cannot be opened: No such file"));
    EXPECT_THAT(error_of([&] { read_file(folder.path); }), HasSubstr("is a folder; expected a file"));
    EXPECT_THAT(error_of([&] { read_file("/dev/zero"); }), HasSubstr("/dev/zero: is a device"));
    put("");
    EXPECT_THAT(error_of([&] { read_file(path); }), HasSubstr("is empty"));
}

TEST_F(FileTest, NeverWaitsForAFifo) {
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    ::alarm(60);  // rather than hanging the whole run
    EXPECT_THAT(error_of([&] { read_file(path); }), HasSubstr("is a pipe (FIFO)"));
    EXPECT_THAT(error_of([&] { write_file(path, bytes_of("x")); }), HasSubstr("it is a pipe (FIFO)"));
    ::alarm(0);
}

TEST_F(FileTest, MessagesHoldNoControlCharacter) {
    const std::string error = error_of([&] { read_file(folder.path / "a\nb\x1b[31m\xff\xc2\x9b\xc3\xa4"); });
    EXPECT_THAT(error, HasSubstr("a?b?[31m???\xc3\xa4: cannot"));
}

TEST_F(FileTest, KeepsThePermissionsOfTheOldFileAndGivesANewOneTheUsual) {
    const mode_t umask = ::umask(027);
    write_file(path, bytes_of("new"));
    EXPECT_EQ(mode_of(path), 0640u);
    ASSERT_EQ(::chmod(path.c_str(), 0604), 0);
    write_file(path, bytes_of("newer"));
    ::umask(umask);
    EXPECT_EQ(mode_of(path), 0604u);
    EXPECT_EQ(got(), "newer");
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
}

TEST_F(FileTest, WritesThroughSymbolicLinks) {
    const fs::path link = folder.path / "link", second = folder.path / "second";
    fs::create_directory(folder.path / "sub");
    path = folder.path / "sub" / "target";
    fs::create_symlink("sub/target", link);
    fs::create_symlink(link, second);
    write_file(second, bytes_of("through a link to nothing yet"));
    EXPECT_EQ(got(), "through a link to nothing yet");
    write_file(second, bytes_of("again"));
    EXPECT_EQ(got(), "again");
    EXPECT_TRUE(fs::is_symlink(link) && fs::is_symlink(second));
    EXPECT_EQ(names_in(folder.path / "sub"), std::vector<std::string>{"target"});

    fs::create_symlink("round", folder.path / "round");
    EXPECT_THAT(error_of([&] { write_file(folder.path / "round", bytes_of("x")); }),
                HasSubstr("Too many levels"));
}

// Never a device of the system: were the check gone, a test run by root would put a file in its place.
TEST_F(FileTest, RefusesToWriteOverWhatIsNoFile) {
    EXPECT_THAT(
        error_of([&] { write_file(folder.path, bytes_of("x")); }),
        ::testing::AllOf(HasSubstr("cannot save " + folder.path.string()), HasSubstr("it is a folder")));
    EXPECT_THAT(error_of([&] { write_file(folder.path / "no" / "file", bytes_of("x")); }),
                HasSubstr("No such file or directory"));
    EXPECT_THAT(error_of([&] { write_file("", bytes_of("x")); }), HasSubstr("it names no file"));
    EXPECT_TRUE(names_in(folder.path).empty());
}

TEST_F(FileTest, InPortionsNothingIsSeenBeforeTheEnd) {
    put("old");
    {
        FileWriter writer(path);
        writer.write(bytes_of("one "));
        writer.write(bytes_of("two"));
        EXPECT_EQ(got(), "old");
    }
    EXPECT_EQ(got(), "old") << "given up";
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
    FileWriter writer(path);
    writer.write(bytes_of("one long beginning"));
    writer.restart();
    writer.write(bytes_of("two, "));
    writer.write(bytes_of("three"));
    EXPECT_EQ(got(), "old");
    writer.finish();
    EXPECT_EQ(got(), "two, three");
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
    EXPECT_THAT(error_of([&] { FileWriter(folder.path / "no" / "file"); }), HasSubstr("cannot save"));
}

TEST_F(FileTest, LeavesAReadOnlyFileAlone) {
    put("old");
    ASSERT_EQ(::chmod(path.c_str(), 0444), 0);
    const uid_t self = ::geteuid();
    if (self == 0) {  // root may write any file: the write is then somebody else's, in a folder of his own
        constexpr uid_t nobody = 65534;
        for (const auto& owned : {folder.path, path})
            ASSERT_EQ(::chown(owned.c_str(), nobody, gid_t(-1)), 0) << owned;
        ASSERT_EQ(::seteuid(nobody), 0);
    }
    const std::string error = error_of([&] { write_file(path, bytes_of("new")); });
    ASSERT_EQ(::seteuid(self), 0);
    EXPECT_THAT(error, HasSubstr("Permission denied"));
    EXPECT_EQ(got(), "old");
}

TEST_F(FileTest, AFailedWriteKeepsTheOldFileAndLeavesNoOther) {
    put("old");
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit small{1000, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string error = error_of([&] { write_file(path, std::vector<std::byte>(100'000)); });
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, handler);
    EXPECT_THAT(error, HasSubstr("cannot save " + path.string() + ": File too large"));
    EXPECT_EQ(got(), "old");
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
}

/// What a program that was killed while it saved `path` leaves.
std::string left_over(const fs::path& path) {
    FileWriter writer(path);
    const auto names = names_in(path.parent_path());
    const auto name = std::find_if(names.begin(), names.end(),
                                   [](const std::string& n) { return n.ends_with(".probewarp-tmp"); });
    return name == names.end() ? "" : *name;
}

TEST_F(FileTest, TakesNamesOfTheGreatestLength) {
    for (const std::size_t length :
         std::initializer_list<std::size_t>{216, 217, 218, 219, 222, 223, 224, 250, 255}) {
        path = folder.path / std::string(length, 'n');
        const std::string name = left_over(path);
        EXPECT_LE(name.size(), 255u);
        std::ofstream(folder.path / name) << "left over";
        write_file(path, bytes_of("x"));
        EXPECT_EQ(got(), "x");
        EXPECT_EQ(names_in(folder.path).size(), 1u) << length;
        fs::remove(path);
    }
}

TEST_F(FileTest, TemporaryNamesAreCutBetweenCharacters) {
    std::string name;
    while (name.size() < 254) name += "\xc3\xa4";
    const std::string temporary = left_over(folder.path / name);
    EXPECT_FALSE(temporary.empty());
    for (std::size_t i = 0; i + 1 < temporary.size(); ++i)
        EXPECT_EQ(temporary[i] == '\xc3', temporary[i + 1] == '\xa4');
    EXPECT_NE(left_over(folder.path / name), left_over(folder.path / ("x" + name.substr(2))));
}

TEST_F(FileTest, RemovesWhatAKilledProgramLeftOfTheSameFileOnly) {
    const std::string own = left_over(path), other = left_over(folder.path / "file2");
    for (const std::string& name : {own, other}) std::ofstream(folder.path / name) << "left over";
    FileWriter locked(folder.path / "file3");  // another save, under way
    write_file(path, bytes_of("new"));
    EXPECT_EQ(got(), "new");
    EXPECT_FALSE(fs::exists(folder.path / own));
    EXPECT_TRUE(fs::exists(folder.path / other));
    EXPECT_EQ(names_in(folder.path).size(), 3u);
}

// What is signalled runs in a process of its own, which ends by the signal.

TEST_F(FileTest, ASignalRemovesATemporaryFileAndKeepsTheOldOne) {
    put("old");
    const auto signalled = [&] {
        remove_temporary_files_on_signals();
        FileWriter writer(path);
        writer.write(bytes_of("new"));
        std::raise(SIGTERM);
    };
    EXPECT_EXIT(signalled(), ::testing::KilledBySignal(SIGTERM), "");
    EXPECT_EQ(got(), "old");
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
}

TEST_F(FileTest, ASignalLeavesANameThatIsNoLongerOurs) {
    const std::string name = left_over(path);
    ASSERT_FALSE(name.empty());
    const auto finished = [&](bool destroyed) {
        remove_temporary_files_on_signals();
        auto writer = std::make_unique<FileWriter>(path);
        writer->write(bytes_of("new"));
        writer->finish();
        if (destroyed) writer.reset();
        std::ofstream(folder.path / name) << "another program's";
        std::raise(SIGTERM);
    };
    for (const bool destroyed : {false, true}) {
        put("old");
        EXPECT_EXIT(finished(destroyed), ::testing::KilledBySignal(SIGTERM), "");
        EXPECT_EQ(got(), "new");
        EXPECT_TRUE(fs::exists(folder.path / name)) << destroyed;
        fs::remove(folder.path / name);
    }
}

TEST_F(FileTest, ASignalRemovesATemporaryFileThatFollowedARenamedOne) {
    const auto followed = [&] {
        remove_temporary_files_on_signals();
        auto first = std::make_unique<FileWriter>(path);
        first->write(bytes_of("new"));
        first->finish();
        FileWriter second(folder.path / "second");
        first.reset();
        std::raise(SIGTERM);
    };
    EXPECT_EXIT(followed(), ::testing::KilledBySignal(SIGTERM), "");
    EXPECT_EQ(got(), "new");
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
}

TEST_F(FileTest, ATemporaryFileThatCannotBeRenamedIsRemoved) {
    FileWriter writer(path);
    writer.write(bytes_of("new"));
    fs::create_directory(path);
    EXPECT_THAT(error_of([&] { writer.finish(); }), HasSubstr("cannot save"));
    EXPECT_EQ(names_in(folder.path).size(), 2u);
    const auto signalled = [] {
        remove_temporary_files_on_signals();
        std::raise(SIGTERM);
    };
    EXPECT_EXIT(signalled(), ::testing::KilledBySignal(SIGTERM), "");
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
}

TEST_F(FileTest, ManyMayWriteTheSameFileAtOnce) {
    {
        std::vector<std::unique_ptr<FileWriter>> writers;
        for (int i = 0; i < 40; ++i) {
            writers.push_back(std::make_unique<FileWriter>(path));
            writers.back()->write(bytes_of(std::to_string(i)));
        }
        EXPECT_EQ(names_in(folder.path).size(), writers.size());
        writers[20]->finish();
        EXPECT_EQ(got(), "20");
        writers[5]->finish();
        EXPECT_EQ(got(), "5");
    }
    EXPECT_EQ(names_in(folder.path), std::vector<std::string>{"file"});
}

TEST_F(FileTest, TheSameFileIsKnownByEveryName) {
    put("x");
    fs::create_directory(folder.path / "sub");
    fs::create_symlink("file", folder.path / "soft");
    fs::create_hard_link(path, folder.path / "hard");
    fs::create_directory_symlink(folder.path, folder.path / "sub" / "up");
    for (const fs::path& name :
         {fs::path("soft"), fs::path("hard"), fs::path("./file"), fs::path("sub/../file"),
          fs::path("sub/up/file"), fs::path("sub/up/sub/up/soft")})
        EXPECT_TRUE(is_same_file(path, folder.path / name)) << name;
    fs::copy_file(path, folder.path / "copy");
    EXPECT_FALSE(is_same_file(path, folder.path / "copy"));
    EXPECT_FALSE(is_same_file(path, folder.path / "sub"));
}

TEST_F(FileTest, TheSameFileIsKnownBeforeItIsThere) {
    fs::create_symlink("sub/new", folder.path / "soft");
    const auto same = [&](const char* a, const char* b) {
        return is_same_file(folder.path / a, folder.path / b);
    };
    EXPECT_TRUE(same("soft", "sub/new")) << "of a folder that is not there";
    fs::create_directory(folder.path / "sub");
    fs::create_directory_symlink("sub", folder.path / "way");
    EXPECT_TRUE(same("soft", "sub/new"));
    EXPECT_TRUE(same("way/new", "sub/new"));
    EXPECT_TRUE(same("way/a/b/new", "sub/a/b/new"));
    EXPECT_FALSE(same("way/a/b/new", "sub/a/c/new"));
    EXPECT_FALSE(same("new", "sub/new"));
    fs::create_symlink("round", folder.path / "round");
    EXPECT_FALSE(same("round", "file")) << "a circle leads nowhere";
}

TEST_F(FileTest, SaysWhichFileWouldBeWrittenOver) {
    put("x");
    fs::create_symlink("file", folder.path / "soft");
    const UsedFile read[]{{"the input itself", folder.path / "other"}, {"the map", path}};
    const UsedFile apart[]{{"-o a", folder.path / "a"}, {"--save b", folder.path / "b"}};
    const UsedFile over[]{{"-o a", folder.path / "a"}, {"--save soft", folder.path / "soft"}};
    const UsedFile twice[]{{"-o a", folder.path / "a"}, {"--save a", folder.path / "./a"}};
    EXPECT_EQ(why_not_written(read, apart), "");
    EXPECT_EQ(why_not_written(read, over), "--save soft: this is the map; expected another file");
    EXPECT_EQ(why_not_written({}, twice), "--save a: this is the same file as -o a; expected another file");
}

TEST_F(FileTest, AnOpenDescriptorIsKnownForItsFile) {
    put("x");
    const UsedFile files[]{{"another", folder.path / "none"}, {"this", path}};
    std::FILE* open = std::fopen(path.c_str(), "r");
    ASSERT_TRUE(open);
    EXPECT_EQ(find_open_file(files, ::fileno(open)), &files[1]);
    std::fclose(open);
    open = std::fopen("/dev/null", "r");
    ASSERT_TRUE(open);
    const UsedFile device[]{{"a device", "/dev/null"}};
    EXPECT_EQ(find_open_file(device, ::fileno(open)), nullptr) << "what goes to a device harms nothing";
    std::fclose(open);
}

}  // namespace
}  // namespace probewarp

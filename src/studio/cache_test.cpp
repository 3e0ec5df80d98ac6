// SPDX-License-Identifier: Apache-2.0
#include "studio/cache.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>

#include "base/error.h"
#include "io/test_files.h"
#include "studio/production.h"

namespace gischt {
namespace {
namespace fs = std::filesystem;

std::string read_all(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string message_of(const std::function<void()>& f) {
    try {
        f();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Usage);
        return e.what();
    }
    return "nothing was thrown";
}

TEST(CacheLock, IsHeldByOneAndNamesIt) {
    const TestFolder folder("lock");
    {
        const CacheLock lock(folder.file(""));
        EXPECT_TRUE(lock.is_held());
        const std::string said = message_of([&] { CacheLock second(folder.file("")); });
        EXPECT_NE(said.find(fmt::format("process {} ", ::getpid())), std::string::npos) << said;
    }
    EXPECT_EQ(folder.count(), 0);
    EXPECT_TRUE(CacheLock(folder.file("")).is_held());
}

TEST(CacheLock, OfAKilledProcessIsTakenOver) {
    const TestFolder folder("lock");
    const pid_t child = fork();
    if (child == 0) {
        const CacheLock lock(folder.file(""));
        kill(getpid(), SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(folder.count(), 1) << "the file of the lock stays behind";
    EXPECT_TRUE(CacheLock(folder.file("")).is_held());
    EXPECT_EQ(folder.count(), 0);
}

// A small scene and where its frames lie.
struct Small {
    explicit Small(const std::string& name) : folder(name) {}
    void simulate(int last, Job& job) {
        Order order;
        order.frames = {1, last, 1};
        order.cache = folder.file("");
        RunStatistics run;
        gischt::simulate(scene, order, run, job);
        computed = static_cast<int>(run.frames.size());
    }
    TestFolder folder;
    LoadedScene scene = load_scene("plume", "", {"domain.resolution=16"});
    int computed = 0;
};

TEST(Cache, IsSharedByThoseWhoOnlyLook) {
    Small s("cache_shared");
    Job job;
    s.simulate(1, job);
    const fs::path folder = s.folder.file("");
    const Cache looking(folder, s.scene, false, true), too(folder, s.scene, false, true);
    const Cache writing(folder, s.scene, false);
    EXPECT_NE(message_of([&] { Cache(folder, s.scene, false); }).find("writes to this cache"),
              std::string::npos);
    EXPECT_NE(message_of([&] { looking.claim(); }).find("writes to this cache"), std::string::npos);
}

TEST(Cache, IsCleanedOfWhatKilledProcessesLeft) {
    Small s("cache_orphans");
    put(s.folder.file(".smoke_0009.gischt-999999999-4.vdb"), "half a frame");
    Job job;
    s.simulate(1, job);
    EXPECT_EQ(s.folder.count(), 3) << "scene.toml, a frame, a state";
}

// A state that is lost or damaged costs time, and nothing else.
TEST(Cache, ADamagedStateIsSimulatedAnew) {
    Small s("cache_state");
    Job job;
    s.simulate(3, job);
    const std::string third = read_all(s.folder.file("smoke_0003.vdb"));
    fs::remove(s.folder.file("smoke_0003.vdb"));
    fs::resize_file(s.folder.file("smoke.state"), 1000);
    std::string said;
    job.on_message = [&](Job::Level, std::string_view text) { said += text; };
    s.simulate(3, job);
    EXPECT_NE(said.find("smoke.state"), std::string::npos) << said;
    EXPECT_EQ(read_all(s.folder.file("smoke_0003.vdb")), third);
}

TEST(Cache, AFrameMissingInBetweenDoesNotTakeTheStateBack) {
    Small s("cache_back");
    Job job;
    s.simulate(4, job);
    fs::remove(s.folder.file("smoke_0002.vdb"));
    s.simulate(4, job);
    EXPECT_EQ(s.computed, 2) << "frames 1 and 2";
    s.simulate(5, job);
    EXPECT_EQ(s.computed, 1) << "frame 5, from the state of frame 4";
}

}  // namespace
}  // namespace gischt

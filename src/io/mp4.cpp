// SPDX-License-Identifier: Apache-2.0
#include "io/mp4.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <span>
#include <vector>

#include "base/error.h"
#include "io/atomic_file.h"

extern char** environ;

namespace gischt {
namespace {

std::vector<std::string> arguments(const std::string& target, int width, int height,
                                   const Mp4Options& options) {
    std::vector<std::string> list{
        "ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
        // What comes in: the bytes of the frames.
        "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size",
        fmt::format("{}x{}", width, height), "-framerate",
        fmt::format("{}", options.frames_per_second), "-i", "pipe:0",
        // What goes out; the matrix is named twice, for the conversion and for the players.
        "-an", "-vf",
        "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd+full_chroma_int+bicubic,"
        "format=yuv420p",
        "-c:v", "libx264", "-preset", "medium", "-crf", fmt::format("{}", options.quality),
        "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range",
        "tv",
        // x264's bits depend on its number of threads, so that number is fixed, and nothing of the
        // date or the versions goes into the file.
        "-threads", "8", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-movflags",
        "+faststart+use_metadata_tags"};
    for (const auto& [key, value] : options.metadata.entries) {
        list.insert(list.end(), {"-metadata", key + "=" + value});
    }
    list.insert(list.end(), {"-f", "mp4", target});
    return list;
}

// A running ffmpeg. It is fed through a socket rather than a pipe, because only on sockets a write
// to a dead reader can be asked to fail without the signal SIGPIPE.
class Process {
  public:
    Process(const std::vector<std::string>& arguments, const std::string& where) : where_(where) {
        std::array<int, 2> ends{-1, -1};
        errors_ = std::tmpfile();
        if (!errors_ || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
            const int code = errno;
            if (errors_) std::fclose(errors_);
            throw Error(ErrorKind::Resource, where, std::strerror(code));
        }
        feed_ = ends[1];
        const int code = spawn(arguments, ends[0]);
        ::close(ends[0]);
        if (code == 0) return;
        close_all();
        const std::string hint = code == ENOENT ? "install the package ffmpeg" : "";
        throw Error(ErrorKind::Resource, where,
                    fmt::format("cannot start the program ffmpeg: {}", std::strerror(code)), hint);
    }
    ~Process() {
        if (id_ > 0) {
            ::kill(id_, SIGKILL);
            wait();
        }
        close_all();
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    void write(std::span<const std::uint8_t> bytes) {
        while (!bytes.empty()) {
            const ssize_t n = ::send(feed_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (n < 0 && errno == EINTR) continue;
            if (n < 0) {
                finish();  // throws what ffmpeg said
                throw Error(ErrorKind::Resource, where_, "ffmpeg stopped reading");
            }
            bytes = bytes.subspan(static_cast<std::size_t>(n));
        }
    }

    // Ends the input and waits. Throws when ffmpeg failed.
    void finish() {
        ::close(feed_);
        feed_ = -1;
        const int status = wait();
        const std::string said = last_words();
        // It says errors only, and ends with 0 when the disk takes no more.
        if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && said.empty()) return;
        throw Error(ErrorKind::Resource, where_,
                    said.empty() ? "ffmpeg failed" : fmt::format("ffmpeg failed: {}", said));
    }

  private:
    int spawn(const std::vector<std::string>& arguments, int input) {
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_adddup2(&files, input, 0);
        posix_spawn_file_actions_addopen(&files, 1, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&files, ::fileno(errors_), 2);
        // In a process group of its own: Ctrl-C in the terminal is for gischt, which then decides
        // what becomes of the movie.
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
        std::vector<char*> words;
        for (const auto& a : arguments) words.push_back(const_cast<char*>(a.c_str()));
        words.push_back(nullptr);
        const int code = ::posix_spawnp(&id_, words[0], &files, &attributes, words.data(), environ);
        if (code != 0) id_ = -1;
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&files);
        return code;
    }

    int wait() {
        int status = 0;
        if (id_ > 0) {
            while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
            }
        }
        id_ = -1;
        return status;
    }

    // The last line of what ffmpeg wrote to its standard error.
    std::string last_words() const {
        std::string text;
        std::array<char, 4096> buffer;
        std::rewind(errors_);
        for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), errors_)) > 0;) {
            text.append(buffer.data(), n);
            if (text.size() > 65536) text.erase(0, text.size() - 4096);
        }
        while (text.ends_with('\n')) text.pop_back();
        return text.substr(text.rfind('\n') + 1);
    }

    void close_all() {
        if (feed_ >= 0) ::close(feed_);
        feed_ = -1;
        if (errors_) std::fclose(errors_);
        errors_ = nullptr;
    }

    std::string where_;
    std::FILE* errors_ = nullptr;
    int feed_ = -1;
    pid_t id_ = -1;
};

int even(int size) {
    return size + size % 2;
}

// The frame with its last column and row repeated where a size is odd.
std::vector<std::uint8_t> pad_to_even(const std::vector<std::uint8_t>& rgb, int width, int height) {
    if (width % 2 == 0 && height % 2 == 0) return rgb;
    std::vector<std::uint8_t> out;
    const auto row = static_cast<std::ptrdiff_t>(width) * 3;
    for (int y = 0; y < even(height); ++y) {
        const auto start = rgb.begin() + row * std::min(y, height - 1);
        out.insert(out.end(), start, start + row);
        if (width % 2) out.insert(out.end(), start + row - 3, start + row);
    }
    return out;
}

}  // namespace

struct Mp4Writer::Impl {
    Impl(const std::string& path, int w, int h, const Mp4Options& o)
        : width(w),
          height(h),
          options(o),
          file(path),
          ffmpeg(arguments(file.temporary(), even(w), even(h), o), path) {}

    int width, height;
    Mp4Options options;
    AtomicFile file;  // before ffmpeg, so that it outlives it
    Process ffmpeg;
    int frames = 0;
};

Mp4Writer::Mp4Writer(const std::string& path, int width, int height, const Mp4Options& options) {
    if (width < 1 || height < 1 || width > 16384 || height > 16384) {
        throw Error(ErrorKind::Usage, path, fmt::format("a movie of {} x {}", width, height),
                    "H.264 has up to 16384 pixels per side");
    }
    if (!(options.frames_per_second > 0 && options.frames_per_second <= 1000)) {
        throw Error(ErrorKind::Usage, path,
                    fmt::format("{} frames per second", options.frames_per_second),
                    "more than 0, at most 1000");
    }
    impl_ = std::make_unique<Impl>(path, width, height, options);
}

Mp4Writer::~Mp4Writer() = default;

void Mp4Writer::add(const Image& image) {
    Impl& m = *impl_;
    if (image.width != m.width || image.height != m.height) {
        throw Error(ErrorKind::Usage, m.file.path(),
                    fmt::format("a frame of {} x {} in a movie of {} x {}", image.width,
                                image.height, m.width, m.height));
    }
    m.ffmpeg.write(pad_to_even(to_rgb8(image, m.options.display), m.width, m.height));
    ++m.frames;
}

void Mp4Writer::finish() {
    if (impl_->frames == 0) {
        throw Error(ErrorKind::Usage, impl_->file.path(), "a movie needs at least one frame");
    }
    impl_->ffmpeg.finish();
    impl_->file.commit();
}

}  // namespace gischt

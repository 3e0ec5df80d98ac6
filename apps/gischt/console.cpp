// SPDX-License-Identifier: Apache-2.0
#include "console.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace gischt {
namespace {

Job* signalled_job = nullptr;

void on_signal(int) {
    if (signalled_job->is_cancelled()) _exit(130);
    signalled_job->cancel();
}

ProgressStyle style_of(const CommandContext& context) {
    if (context.quiet || context.progress == "none") return ProgressStyle::None;
    if (context.progress == "json") return ProgressStyle::Json;
    if (context.progress == "plain") return ProgressStyle::Plain;
    if (context.progress == "bar") return ProgressStyle::Bar;
    return isatty(STDERR_FILENO) ? ProgressStyle::Bar : ProgressStyle::Plain;
}

// Writes progress to stderr, at most ten times a second as a bar and every 10 % as plain lines.
class ProgressPrinter {
  public:
    explicit ProgressPrinter(ProgressStyle style) : style_(style), start_(now_seconds()) {}

    void show(double fraction, std::string_view phase) {
        fraction = std::clamp(fraction, 0.0, 1.0);
        const double now = now_seconds();
        const bool due = style_ == ProgressStyle::Bar ? now - last_ >= 0.1
                                                      : fraction >= next_ || now - last_ >= 30;
        if (style_ == ProgressStyle::None || (!due && fraction < 1) || (fraction >= 1 && done_))
            return;
        last_ = now;
        next_ = (std::floor(fraction * 10) + 1) / 10;
        done_ = fraction >= 1;
        print(fraction, phase, now - start_);
    }
    // Leaves the line of the bar, before a message or the end.
    void clear() {
        if (style_ == ProgressStyle::Bar && last_ > 0) std::fputs("\r\033[K", stderr);
    }

  private:
    void print(double fraction, std::string_view phase, double elapsed) {
        const double left = fraction > 0.01 ? elapsed * (1 - fraction) / fraction : -1;
        if (style_ == ProgressStyle::Json) {
            nlohmann::json line = {{"fraction", fraction}, {"phase", phase}, {"elapsed", elapsed}};
            if (left >= 0) line["left"] = left;
            return put(line.dump() + "\n");
        }
        const std::string rest = left >= 0 ? ", " + duration_text(left) + " left" : "";
        if (style_ == ProgressStyle::Bar) {
            const auto filled = static_cast<std::size_t>(fraction * 30);
            put(fmt::format("\r\033[K[{}{}] {:3.0f} % {}{}", std::string(filled, '#'),
                            std::string(30 - filled, '.'), fraction * 100, phase, rest));
        } else {
            put(fmt::format("{:3.0f} % {}{}\n", fraction * 100, phase, rest));
        }
    }
    // Nobody may be listening: that is no reason to end the work.
    static void put(const std::string& text) {
        std::fputs(text.c_str(), stderr);
        std::fflush(stderr);
    }

    ProgressStyle style_;
    double start_, last_ = 0, next_ = 0;
    bool done_ = false;
};

}  // namespace

std::string duration_text(double seconds) {
    const auto s = static_cast<long>(std::lround(seconds));
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
    return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

Console::Console(CommandContext& context) {
    auto log = std::make_shared<spdlog::logger>(
        "gischt", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    log->set_pattern("%^%v%$");
    log->set_level(context.quiet ? spdlog::level::err : spdlog::level::info);
    auto printer = std::make_shared<ProgressPrinter>(style_of(context));
    // The job calls both under its own lock.
    context.job.on_progress = [printer](double fraction, std::string_view phase) {
        printer->show(fraction, phase);
    };
    context.job.on_message = [printer, log](Job::Level level, std::string_view text) {
        printer->clear();
        if (level == Job::Level::Warning)
            log->warn("warning: {}", text);
        else
            log->info("{}", text);
    };
    signalled_job = &context.job;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
    // A terminal that closes; nohup has it ignored.
    if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

Console::~Console() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    if (isatty(STDERR_FILENO)) std::fputs("\r\033[K", stderr);
}

}  // namespace gischt

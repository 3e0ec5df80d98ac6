// SPDX-License-Identifier: Apache-2.0
#include "image/film_state.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace gischt {
namespace {

// A film whose pixels hold the samples [begin, end), sample s of pixel p being 10 p + s.
FilmState part(int begin, int end) {
    FilmState state;
    state.film.emplace(2, 1, ReconstructionFilter(FilterKind::Box));
    for (int p = 0; p < 2; ++p) {
        for (int s = begin; s < end; ++s) {
            state.film->add(p, 0, {Vec3f(static_cast<float>(10 * p + s))});
        }
    }
    state.ranges = {{begin, end}};
    state.tile_goals = {end - begin};
    return state;
}

TEST(FilmState, MergesRangesInAnyOrder) {
    FilmState state = part(8, 12);
    state.merge(part(0, 4));
    EXPECT_EQ(to_text(state.ranges), "0:4, 8:12");
    state.merge(part(4, 8));
    EXPECT_EQ(to_text(state.ranges), "0:12");
    EXPECT_TRUE(state.is_complete());
    EXPECT_EQ(state.image(), part(0, 12).image());
}

TEST(FilmState, RefusesSamplesThatWouldCountTwice) {
    FilmState state = part(0, 8);
    try {
        state.merge(part(6, 9));
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        EXPECT_NE(std::string(e.what()).find("6:8"), std::string::npos) << e.what();
    }
    EXPECT_EQ(state.image(), part(0, 8).image());  // untouched
    FilmState other = part(8, 9);
    other.film.emplace(2, 1, ReconstructionFilter(FilterKind::Gaussian));
    EXPECT_THROW(state.merge(other), Error);
}

TEST(FilmState, KnowsWhetherPixelsLackSamples) {
    FilmState state = part(0, 4);
    state.film->add(1, 0, {Vec3f(1)});
    state.ranges = {{0, 5}};
    EXPECT_FALSE(state.is_complete());
    state.merge(part(5, 6));
    EXPECT_FALSE(state.is_complete());
    state.has_samples = state.has_variance = true;
    const Image image = state.image();
    EXPECT_EQ(image.channel("samples.Y")[0], 5);
    EXPECT_EQ(image.channel("samples.Y")[1], 6);
    EXPECT_EQ(image.channel("variance.Y")[0], static_cast<float>(state.film->variance(0, 0)));
}

}  // namespace
}  // namespace gischt

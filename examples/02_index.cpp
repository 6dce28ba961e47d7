// A spatial index of named values, without the rest of Fase.
#include <cstdio>
#include <string>

#include "fase/query/index.hpp"

int main() {
    fase::Index<std::string> yard;
    yard.insert({{0, 0, 0}, {4, 3, 5}}, "shed");
    const auto ball = yard.insert({{7, 0, 1}, {8, 1, 2}}, "ball");
    yard.insert({{3, 0, 4}, {6, 1, 6}}, "bench");
    yard.commit();

    yard.pairs([](std::string& a, std::string& b) { std::printf("%s touches %s\n", a.c_str(), b.c_str()); });
    if (const auto hit = yard.cast_ray({{12, 0.5, 1.5}, {-1, 0, 0}, 100}))
        std::printf("looking left: the %s, %.1f m away\n", yard.value(hit->id).c_str(), hit->distance);

    yard.move(ball, {{5, 0, 5}, {6, 1, 6}});
    yard.commit();
    yard.at({5.5, 0.5, 5.5}, [](std::string& thing) { std::printf("at the bench's end: %s\n", thing.c_str()); });
}

# The program in Debian 12: `docker build -t muslin .`; docs/guide/install.md says how to run it.
FROM debian:12-slim AS build
WORKDIR /muslin
COPY tools/setup tools/setup
RUN tools/setup
COPY . .
RUN cmake --preset release -D MUSLIN_BUILD_TESTS=OFF -D MUSLIN_BUILD_BENCH=OFF \
 && cmake --build build/release --target muslin_program \
 && strip build/release/muslin

FROM debian:12-slim
# Versions are those of Debian 12, which changes them for security only.
# hadolint ignore=DL3008
RUN apt-get update \
 && apt-get install --yes --no-install-recommends \
    ffmpeg libassimp5 libembree3-3 libfmt9 libosdcpu3.5.0 libpng16-16 libtbb12 libtomlplusplus3 \
 && rm -rf /var/lib/apt/lists/*
COPY --from=build /muslin/build/release/muslin /usr/local/bin/muslin
COPY --from=build /muslin/LICENSE /usr/local/share/doc/muslin/LICENSE
COPY --from=build /muslin/scenes /usr/local/share/muslin/scenes
WORKDIR /work
ENTRYPOINT ["muslin"]
CMD ["--help"]

# SPDX-License-Identifier: Apache-2.0
# mirrorball with PoCL:  docker build -t mirrorball:0.1.0 .
#   docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" mirrorball:0.1.0 render scenes/cornell-box.json -o out.png
FROM debian:12 AS build
COPY . /source
WORKDIR /source
RUN scripts/install \
    && cmake -S . -B build/release -G Ninja -DMIRRORBALL_TESTS=OFF \
    && cmake --build build/release \
    && cpack -G DEB -B /package --config build/release/CPackConfig.cmake

FROM debian:12-slim
COPY --from=build /package/*.deb /tmp/
RUN apt-get update \
    && apt-get install -y --no-install-recommends /tmp/*.deb pocl-opencl-icd libopenexr-3-1-30 \
    && rm -rf /tmp/*.deb /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["mirrorball"]

# For the scripts in tools: the packages of Debian 12 that they need and how to get them, and what several of them do.
# Sourced by bash from the top of the tree.

# What must be there, each behind the command or file that shows that it is.
needed_to_build=(
  cmake:cmake
  ninja:ninja-build
  c++:g++
  make:make  # GCC itself calls it, to optimise at link time with all cores
  python3:python3
  esbuild:esbuild  # makes the page of `s7200 view` of its TypeScript
  /usr/include/boost/spirit/home/x3.hpp:libboost-dev
  /usr/include/fmt/format.h:libfmt-dev
  /usr/include/histedit.h:libedit-dev
  /usr/include/zlib.h:zlib1g-dev
  /usr/include/curses.h:libncurses-dev
  /usr/include/CLI/CLI.hpp:libcli11-dev
  /usr/include/nlohmann/json.hpp:nlohmann-json3-dev
  /usr/include/yaml-cpp/yaml.h:libyaml-cpp-dev
)

# What it needs besides where it is configured with tests, which it is unless BUILD_TESTING is OFF.
needed_to_build_tests=(
  /usr/include/gtest/gtest.h:libgtest-dev
  /usr/include/benchmark/benchmark.h:libbenchmark-dev
)

# What s7200.exe needs besides, and the package that it goes into.
needed_to_build_windows=(
  x86_64-w64-mingw32-g++-posix:g++-mingw-w64-x86-64-posix
  /usr/x86_64-w64-mingw32/include/zlib.h:libz-mingw-w64-dev
  zip:zip
  unzip:unzip
  node:nodejs
  npm:npm
)

# What the package for arm64 needs besides.
needed_to_build_arm64=(
  aarch64-linux-gnu-g++:g++-aarch64-linux-gnu
  qemu-aarch64:qemu-user
)

# The packages of the libraries that the command of a release is linked with.
linked_libraries=(libbsd0 libc6 libedit2 libfmt9 libgcc-s1 libmd0 libstdc++6 libtinfo6 libyaml-cpp0.7 zlib1g)

# What the page with its engine in one file needs besides, which --report fills in: the target page_file.
needed_for_page_file=(
  clang++-19:clang-19
  wasm-ld-19:lld-19
  wasm-opt:binaryen
  zopfli:zopfli
  llvm-ar-19:llvm-19
  /usr/include/wasm32-wasi/stdio.h:wasi-libc
  /usr/lib/llvm-19/lib/wasm32-wasi/libc++.a:libc++-19-dev-wasm32
  /usr/lib/llvm-19/lib/wasm32-wasi/libc++abi.a:libc++abi-19-dev-wasm32
  /usr/lib/llvm-19/lib/clang/19/lib/wasi/libclang_rt.builtins-wasm32.a:libclang-rt-19-dev-wasm32
)

# What cpack needs for the Debian package besides.
needed_to_package=(
  dpkg-shlibdeps:dpkg-dev
  file:file
)

# What the tests need besides: masters and decoders of others, that s7200 has to agree with, and what shows its manual pages,
# completes its command lines and runs it in the pipelines of others.
needed_to_test=(
  "${needed_to_build_tests[@]}"
  "${needed_for_page_file[@]}"
  "${needed_to_package[@]}"
  /usr/include/modbus/modbus.h:libmodbus-dev
  /usr/lib/python3/dist-packages/pymodbus:python3-pymodbus
  /usr/lib/python3/dist-packages/serial_asyncio:python3-serial-asyncio
  /usr/lib/python3/dist-packages/serial:python3-serial
  /usr/sbin/ser2net:ser2net
  mold:mold
  mbpoll:mbpoll
  sigrok-cli:sigrok-cli
  vcd2fst:gtkwave
  tshark:tshark
  bash:bash
  fish:fish
  groff:groff-base
  zsh:zsh
  pytest-3:python3-pytest
  /usr/lib/python3/dist-packages/yaml:python3-yaml
  chromium:chromium
  node:nodejs
  npm:npm
  x86_64-w64-mingw32-g++-posix:g++-mingw-w64-x86-64-posix
  /usr/lib/wine/wine64:wine64
  "${needed_to_build_arm64[@]}"
)

# install_missing_packages COMMAND:PACKAGE...
install_missing_packages() {
  local entry sign missing=() as_root=()
  for entry in "$@"; do
    sign=${entry%%:*}
    case $sign in
      /*) [ -e "$sign" ] || missing+=("${entry#*:}") ;;
      *) command -v "$sign" >/dev/null || missing+=("${entry#*:}") ;;
    esac
  done
  if [ "${#missing[@]}" -eq 0 ]; then return; fi
  if ! command -v apt-get >/dev/null; then
    echo "Note: no apt-get here. If the build stops, install what corresponds to these packages of Debian: ${missing[*]}" >&2
    return
  fi
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "error: to install packages this needs root or sudo. As root: apt-get install ${missing[*]}" >&2
      exit 2
    fi
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  as_root+=(env DEBIAN_FRONTEND=noninteractive apt-get -qq)
  if ! { "${as_root[@]}" update && "${as_root[@]}" install --no-install-recommends "${missing[@]}" >/dev/null; }; then
    echo "error: could not install ${missing[*]}; see above. As root: apt-get install ${missing[*]}" >&2
    exit 2
  fi
}

# takes_only GIVEN ALLOWED...: ends a script that was given another word, with what stands in its head.
takes_only() {
  local given=$1 allowed
  shift
  for allowed in "$@"; do if [ "$given" = "$allowed" ]; then return; fi; done
  echo "error: $0 does not take '$given'" >&2
  sed -n '2,/^[^#]/s/^# \?//p' "$(basename "$0" | sed 's|^|tools/|')" >&2
  exit 2
}

# own_apt_get FOLDER OPTION...: sets apt_get to an apt-get with lists of its own in a folder, which changes nothing of this computer.
own_apt_get() {
  local folder=$1 option
  shift
  mkdir -p "$folder/lists/partial" "$folder/cache/archives/partial"
  apt_get=(apt-get -qq -o "Dir::State::Lists=$folder/lists" -o "Dir::Cache=$folder/cache" -o "APT::Sandbox::User=")
  for option in "$@"; do apt_get+=(-o "$option"); done
}

# Options of cmake for build.
configured_with=()

# build PRESET [TARGET...]: all targets if none is named.
build() {
  local preset=$1
  shift
  mkdir -p build
  if ! cmake --preset "$preset" "${configured_with[@]}" >"build/$preset-configure.log" 2>&1; then
    cat "build/$preset-configure.log" >&2
    exit 2
  fi
  cmake --build --preset "$preset" --parallel "$(nproc)" ${1+--target "$@"}
}

# for_release: sets version, and SOURCE_DATE_EPOCH unless it is set: the time of all files in packages, that of the last commit.
# The options in for_debian keep the names of folders of this computer out of the command.
for_release() {
  version=$(sed -n 's/^project(s7200 VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
  export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date +%s)}
  umask 022
  unset CXXFLAGS LDFLAGS  # those of this computer are not for others
  export CCACHE_BASEDIR=  # where it is set, names of headers in messages would be relative to the folder of the build
  for_debian=("-DCMAKE_CXX_FLAGS=\"-ffile-prefix-map=$PWD=s7200\"")
}

# build_page BUILD: the page with its engine in one file, which is the same for all builds.
build_page() {
  local configured_with=()
  build wasm engine
  mkdir -p "$1/share/s7200"
  tools/faces/page/build build/wasm/tools/faces/page/engine/engine.wasm "$1/share/s7200/page.html"
}

# make_deb BUILD: prints the Debian package of a build.
make_deb() {
  rm -f "$1"/packages/s7200_*.deb
  cpack --config "$1/CPackConfig.cmake" >build/cpack.log 2>&1 || { cat build/cpack.log >&2; exit 2; }
  ls "$1"/packages/s7200_*.deb
}

# copy_licences FOLDER PACKAGE...: the licences of libraries, as Debian's packages have them: of those that are headers, of those in the
# page's engine, and of others.
copy_licences() {
  local into=$1 package
  shift
  mkdir -p "$into"
  for package in libboost1.74-dev libcli11-dev libfmt-dev nlohmann-json3-dev libc++-19-dev-wasm32 wasi-libc "$@"; do
    cp "/usr/share/doc/$package/copyright" "$into/$package.txt"
  done
}

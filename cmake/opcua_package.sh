# For ./package --opcua: the package cellmirror-opcua, of ipc/opcua and the packages of npm that its lock file names. Sourced.

# What only those who develop with the packages of npm need. Node sets stay: node-opcua looks for each of them when it is loaded.
prune_modules() {
  local modules=$1
  find "$modules" -type f \( -name '*.map' -o -name '*.ts' -o -name '*.mts' -o -name '*.cts' -o -name '*.flow' -o -name '*.tsbuildinfo' -o \
    -name '.[a-z]*' -o -name '*.md' \) ! -iname 'licen[cs]e*' -delete
  rm -rf "$modules"/@types "$modules"/.bin "$modules"/.package-lock.json "$modules"/node-opcua*/source "$modules"/*/{test,tests,examples}
  find "$modules" -type d -empty -delete
}

# stage_opcua TO VERSION MAINTAINER
stage_opcua() {
  local to=$1 version=$2 maintainer=$3 day
  command -v npm >/dev/null || die "./package: npm, which brings node-opcua, is not installed"
  day=$(LC_ALL=C date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%d)
  rm -rf "$to" && mkdir -p "$to/app" && cp -r config/debian_opcua "$to/debian" || die "./package: $to cannot be written"
  rm "$to/debian/README.md" "$to/debian/control.in"
  cp -r ipc/opcua/{cellmirror-opcua.mjs,package.json,package-lock.json,src} "$to/app/"
  sed -i "s/^  \"version\": \".*\",/  \"version\": \"$version\",/" "$to/app/package.json"
  (cd "$to/app" && npm ci --omit=dev --ignore-scripts --no-audit --no-fund --loglevel=error) >"$to/../npm.log" 2>&1 ||
    die "./package: npm ci failed (full output: $to/../npm.log)"
  prune_modules "$to/app/node_modules"
  (cd "$to/app" && node --input-type=module -e 'await Promise.all(["server", "certificates", "cell_nodes"].map((name) => import(`./src/${name}.mjs`)))') ||
    die "./package: the program cannot load what is left of its packages"
  # One line a package: name, version, licence.
  find "$to/app/node_modules" -name package.json -exec node -e '
    const lines = new Set();
    for (const file of process.argv.slice(1)) {
      const {name, version, license, licenses} = JSON.parse(require("fs").readFileSync(file));
      const licence = license?.type ?? license ?? licenses?.map((one) => one.type).join(" or ");
      if (name && version) lines.add(`${name} ${version}: ${licence ?? "see its folder"}`);
    }
    console.log([...lines].sort().join("\n"));' {} + >"$to/licences.txt" || die "./package: the licences cannot be listed"
  cp config/systemd/cellmirror-opcua@.service "$to/"
  { printf '.TH CELLMIRROR-OPCUA 1 "%s" "cellmirror %s" "User Commands"\n.SH NAME\ncellmirror-opcua \\- robots for clients of OPC UA\n' "$day" "$version"
    printf '.SH DESCRIPTION\n.nf\n'
    node "$to/app/cellmirror-opcua.mjs" --help | sed -e 's/\\/\\e/g' -e 's/-/\\-/g' -e "s/^[.']/\\\\\&&/"
    printf '.fi\n.SH EXIT STATUS\n0: ended by a signal; 1: failed, with a message on standard error; 2: wrong usage\n.SH SEE ALSO\ncellmirror(1)\n'
  } >"$to/cellmirror-opcua.1"
  sed -e "s|@maintainer@|$maintainer|" config/debian_opcua/control.in >"$to/debian/control"
  printf 'cellmirror-opcua (%s) unstable; urgency=medium\n\n  * See CHANGELOG.md.\n\n -- %s  %s\n' "$version" "$maintainer" \
    "$(LC_ALL=C date -u -R -d "@$SOURCE_DATE_EPOCH")" >"$to/debian/changelog"
  find "$to" -exec touch --no-dereference --date="@$SOURCE_DATE_EPOCH" {} +
}

# build_opcua FOLDER VERSION MAINTAINER: the package lies in FOLDER/out-opcua then.
build_opcua() {
  local to=$1 source="$1/opcua/source"
  mkdir -p "$to/opcua" && stage_opcua "$source" "$2" "$3"
  rm -rf "$to/out-opcua" && mkdir "$to/out-opcua"
  (cd "$source" && dpkg-buildpackage --build=binary --no-sign) >"$to/opcua/package.log" 2>&1 </dev/null || {
    tail -n 30 "$to/opcua/package.log" >&2
    die "The package cellmirror-opcua could not be built (full output: $to/opcua/package.log)"
  }
  mv "$to"/opcua/*.deb "$to"/opcua/*.changes "$to"/opcua/*.buildinfo "$to/out-opcua/"
}

# What tests of tools from outside share; sourced with the arguments BIN_DIR SOURCE_DIR. Leaves us in a folder of our own.
set -u
bin=$(cd "$1" && pwd) || exit 2
source_dir=$(cd "$2" && pwd) || exit 2
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
trace=$bin/nullcone-trace info=$bin/nullcone-info geodesic=$bin/nullcone-geodesic
faults=0 checks=0

fault() { faults=$((faults + 1)); printf 'FAULT: %s\n' "$1"; }

# run STATUS COMMAND...: runs within 60 s; output lands in the files out and err.
run() {
  local expected=$1 status
  shift
  checks=$((checks + 1))
  timeout 60 "$@" >out 2>err </dev/null
  status=$?
  [ "$status" -eq "$expected" ] || fault "status $status, expected $expected: $* ($(head -c 300 err))"
}
# refused_with STATUS WORDS COMMAND...: that status, nothing on stdout, exactly one line on stderr that holds the words.
refused_with() {
  local status=$1 words=$2
  shift 2
  run "$status" "$@"
  [ -s out ] && fault "talks on standard output: $*"
  [ "$(wc -l <err)" -eq 1 ] || fault "$(wc -l <err) lines on standard error, expected 1: $*"
  grep -qF -- "$words" err || fault "'$words' is not in '$(head -c 300 err)': $*"
}
finish() {
  printf '%d checks, %d faults\n' "$checks" "$faults"
  [ "$faults" -eq 0 ]
}

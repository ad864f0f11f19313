#!/usr/bin/env bash
# Gate: the service runs as its own user, without a capability, kept from what is not its business, and arms nothing by
# itself. The directives that this rests on are read from the unit; where systemd-analyze is installed its exposure must
# be below 3 as well (1.6 with systemd 252; a unit without any is at 9.6), so a directive that says nothing does not pass.
# Usage: unit_security.sh UNIT
set -euo pipefail
unit=${1:?usage: unit_security.sh UNIT}
problems=0
report() {
  echo "$unit: $1"
  problems=$((problems + 1))
}
directives=$(sed -nE 's/^[[:space:]]*([A-Za-z]+)[[:space:]]*=[[:space:]]*(.*)$/\1=\2/p' "$unit")
# Given, and given last: the last of several counts.
last() { grep "^$1=" <<<"$directives" | tail -n 1 | cut -d = -f 2-; }
for needed in User=palpate Group=palpate CapabilityBoundingSet= AmbientCapabilities= NoNewPrivileges=yes ProtectSystem=strict \
  ProtectHome=yes PrivateTmp=yes DevicePolicy=closed IPAddressDeny=any 'RestrictAddressFamilies=AF_CAN AF_UNIX' \
  SystemCallArchitectures=native ProtectKernelTunables=yes ProtectKernelModules=yes ProtectKernelLogs=yes \
  ProtectControlGroups=yes ProtectClock=yes ProtectHostname=yes RestrictNamespaces=yes RestrictSUIDSGID=yes \
  LockPersonality=yes MemoryDenyWriteExecute=yes UMask=0077 Restart=no; do
  key=${needed%%=*}
  grep -q "^$key=" <<<"$directives" || { report "no $key"; continue; }
  [ "$(last "$key")" = "${needed#*=}" ] || report "$key=$(last "$key"), must be $needed"
done
grep -q '^SystemCallFilter=~.*@privileged' <<<"$directives" || report "no SystemCallFilter=~@privileged"
start=$(last ExecStart)
[[ $start == *'--profile '* ]] || report "ExecStart names no device profile"
[[ $start != *--allow-no-rt* ]] || report "ExecStart drives a device without real-time rights"

if command -v systemd-analyze >/dev/null; then
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  cp "$unit" "$work/palpate@sample.service" # a template has no score
  score=$(systemd-analyze security --offline=true --threshold=30 "$work/palpate@sample.service" 2>&1) ||
    report "systemd-analyze: $(tail -n 1 <<<"$score")"
  grep -q 'Overall exposure level' <<<"$score" || report "systemd-analyze gave no score: $(tail -n 1 <<<"$score")"
  verdict=$(sed -nE 's/.*(Overall exposure level.*: [0-9.]+).*/\1/p' <<<"$score")
else
  verdict='systemd-analyze is not installed: directives only'
fi
[ "$problems" -eq 0 ] || exit 1
echo "unit security: $verdict"

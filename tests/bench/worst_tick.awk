# Reads a combined callgrind file with one part per tick (see tick_instructions.cpp) and prints, per stage, the
# instructions in the worst tick, the most in any tick, and the mean over ticks in contact, for which ticks that were
# chosen do not count; then one line "summary WORST MEAN_IN_CONTACT TICKS TICKS_IN_CONTACT" for the script. `functions`, given with -v: those of the stages,
# in order. With -v each=1 first a line "each TICK STAGE INSTRUCTIONS" for every tick and stage.
function finish(    stage) {
  if (!open_part) return
  if (!chosen) ticks++
  if (each) for (stage in cost) print "each", number, stage, cost[stage]
  if (contacts > 0 && !chosen) { in_contact++; contact_sum += total }
  if (total > worst) {
    worst = total; worst_label = label
    for (stage in cost) worst_cost[stage] = cost[stage]
  }
  for (stage in cost) {
    if (!(stage in most)) others[stage] = 1
    if (cost[stage] > most[stage]) most[stage] = cost[stage]
    if (contacts > 0 && !chosen) sum[stage] += cost[stage]
  }
}
# A method's steps have names of their own where methods share them. What stands between the stages goes with the last.
function name_of(text) {
  gsub(/\(anonymous namespace\)::/, "", text); sub(/\(.*/, "", text); sub(/^.*::/, "", text)
  if (text ~ /^find_/) return "find_rows"
  if (text ~ /^(follow_settings|watch_delay|is_beyond_stated)$/) return "publish"
  return text ~ /^rub/ || text == "load_pieces" ? "account" : text
}
/^part: / { finish(); open_part = 0; total = 0; self = 0; in_tick = 0; split("", cost) }
/^desc: Trigger: Client Request: tick / {
  open_part = 1; number = $6; label = $0; sub(/^.*Request: /, "", label); contacts = $8
  chosen = $NF == "chosen"
}
# What calls stages is none; contact is counted in its parts.
function calls_stages(text) {
  gsub(/\(anonymous namespace\)::/, "", text)
  return text ~ /^palpate::(tick|render|find_forces|tick_as_set|contact)\(/
}
/^fn=/ { in_tick = calls_stages(substr($0, 4)); callee = "" }
/^cfn=/ { callee = substr($0, 5); next }
/^calls=/ { want = 1; next }
/^[0-9+*-]/ {
  if (want) {
    want = 0
    if (callee ~ /^palpate::tick\(/) total += $2
    if (in_tick && !calls_stages(callee)) cost[name_of(callee)] += $2
  } else if (in_tick) cost["publish"] += $2
}
END {
  finish()
  if (ticks == 0 || worst == 0) { print "no tick was counted"; exit 1 }
  # In the tick's order; a callee that is no stage (a compiler's memset, say) comes last.
  stages = split(functions, order, " ")
  for (i = 1; i <= stages; i++) {
    if (!(most[order[i]] > 0)) { print order[i] ": counted in no tick; has it another name, or another caller?"; exit 1 }
    delete others[order[i]]
  }
  for (s in others) order[++stages] = s
  printf "%-22s %12s %12s %16s\n", "stage (instructions)", "worst tick", "most, any", "mean, in contact"
  for (i = 1; i <= stages; i++) {
    s = order[i]
    printf "%-22s %12d %12d %16d\n", s, worst_cost[s], most[s], in_contact ? sum[s] / in_contact : 0
  }
  printf "%-22s %12d %12s %16d   (%s)\n", "tick", worst, "", in_contact ? contact_sum / in_contact : 0, worst_label
  printf "summary %d %d %d %d\n", worst, in_contact ? contact_sum / in_contact : 0, ticks, in_contact
}

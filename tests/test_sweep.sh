#!/bin/sh
# Parameter studies as a user meets them: results the same for any number of threads, for chunks, after a kill and a resume;
# failed runs; messages. Run from the top of the checkout; ends with the line "N passed, N failed".
. tests/program_checks.sh
subcommand=sweep

study() { cat >"$work/$1.nml"; }   # study NAME: a study file from standard input

cp cases/sim_I.nml "$work/base.nml"
sed -i "s/'adams', revolutions = 4.0, relative_tolerance = 1.0e-6/'auto', revolutions = 3.0, relative_tolerance = 1.0e-4/" \
  "$work/base.nml"

# a grid, its rows against single cases
study grid <<'END'
&study case = 'base.nml', cycles = T, strobe_columns = 'crank_angle, eccentricity_x', strobe_angle_deg = 90 /
&parameter key = 'joint.clearance', from = 1e-5, to = 4e-5, count = 4, scale = 'log' /
&parameter key = 'initial.crank_speed', values = 100, 200, 3e2 /
END
run sweep -j 1 -o "$work/one" "$work/grid.nml"
check "a grid runs, status $status" [ "$status" = 0 -a "$(wc -l <"$work/out")" = 1 -a ! -s "$work/err" ]
check "a row for each run" [ "$(wc -l <"$work/one/grid.runs.csv")" = 13 ]
check "the last parameter goes fastest" [ "$(awk -F, 'NR == 3 { print $2, $3 }' "$work/one/grid.runs.csv")" = "1.000000000E-05 200" ]
check "every row has every column" [ "$(awk -F, '{print NF}' "$work/one/grid.runs.csv" | sort -u)" = 18 ]
check "revolutions" [ "$(grep -c '^7,' "$work/one/grid.cycles.csv")" = "$(awk -F, '$1 == 7 { print $5 }' "$work/one/grid.runs.csv")" ]
check "no file under a temporary name" [ -z "$(find "$work/one" -name '*.part')" ]
run -o "$work/single" -s joint.clearance=1.000000000E-05 -s initial.crank_speed=200 "$work/base.nml"
field() { awk -F, -v name="$2" '$1 == name { print $2 }' "$1"; }
check "a row is the case with its values: largest residual" [ "$(field "$work/single/base.summary.csv" max_energy_residual_relative)" = \
  "$(awk -F, '$1 == 2 { print $16 }' "$work/one/grid.runs.csv")" ]
check "a row is the case with its values: evaluations" [ "$(field "$work/single/base.summary.csv" rhs_evaluations)" = \
  "$(awk -F, '$1 == 2 { print $17 }' "$work/one/grid.runs.csv")" ]

same() {   # same NAME FOLDER: all of the grid's files are as one thread wrote them
  for kind in runs cycles strobe; do
    check "$1: $kind" cmp -s "$work/one/grid.$kind.csv" "$2/grid.$kind.csv"
  done
}

run sweep -j 4 -o "$work/four" "$work/grid.nml"
same "four threads" "$work/four"

# chunks
run sweep -o "$work/chunks" --rows 1:5 "$work/grid.nml"
run sweep -o "$work/chunks" --rows 6:12 "$work/grid.nml"
for kind in runs cycles strobe; do
  { cat "$work/chunks/grid.1-5.$kind.csv"; tail -n +2 "$work/chunks/grid.6-12.$kind.csv"; } >"$work/chunks/grid.$kind.csv"
done
same "chunks" "$work/chunks"

# what a killed program leaves: whole rows in any order, a torn one, revolutions of a run that has no row
mkdir "$work/torn"
cp "$work/one/grid.study.nml" "$work/torn"
{ head -n 1 "$work/one/grid.runs.csv"; grep -e '^9,' -e '^4,' "$work/one/grid.runs.csv"; printf '5,1.58740'; } \
  >"$work/torn/grid.runs.csv"
{ head -n 1 "$work/one/grid.cycles.csv"; grep '^9,' "$work/one/grid.cycles.csv"; grep '^5,' "$work/one/grid.cycles.csv"
  grep '^4,' "$work/one/grid.cycles.csv"; printf '5,1'; } >"$work/torn/grid.cycles.csv"
{ head -n 1 "$work/one/grid.strobe.csv"; grep -e '^4,' -e '^9,' "$work/one/grid.strobe.csv"; } >"$work/torn/grid.strobe.csv"
run sweep -o "$work/torn" "$work/grid.nml"
check "a torn sweep is taken up" grep -q '12 runs, 2 of them there already' "$work/out"
same "taken up" "$work/torn"
run sweep -o "$work/torn" "$work/grid.nml"
check "nothing is run twice" grep -q '12 runs, 12 of them there already; [^;]*csv$' "$work/out"
same "run again" "$work/torn"
run sweep -o "$work/torn" -a standard "$work/grid.nml"
check "another base case is not mixed in, status $status" [ "$status" = 5 ]
check "and the way out is named" grep -q 'grid.runs.csv: holds another study.*--fresh' "$work/err"
run sweep -o "$work/torn" -s initial.crank_angle_deg=10 --fresh "$work/grid.nml"
check "--fresh begins anew, status $status" [ "$status" = 0 ]
check "with other results" [ "$(cmp -s "$work/torn/grid.runs.csv" "$work/one/grid.runs.csv"; echo $?)" = 1 ]

# a real kill, and an interrupt
study long <<'END'
&study case = 'base.nml', design = 'latin_hypercube', runs = 1000, seed = 3, cycles = T /
&parameter key = 'joint.clearance', from = 1e-5, to = 4e-5 /
&parameter key = 'lubrication.viscosity', from = 0.005, to = 0.02 /
END
run sweep -o "$work/whole" "$work/long.nml"
for signal in KILL TERM; do
  "$gudgeon" sweep -o "$work/$signal" "$work/long.nml" >"$work/out" 2>"$work/err" &
  pid=$!
  tries=0
  while [ "$(cat "$work/$signal/long.runs.csv" 2>/dev/null | wc -l)" -lt 20 ] && [ $tries -lt 1000 ]; do
    tries=$((tries + 1))
    sleep 0.02
  done
  kill -$signal $pid
  wait $pid 2>/dev/null
  status=$?
  rows=$(wc -l <"$work/$signal/long.runs.csv")
  check "$signal: stopped half way, $rows rows" [ "$rows" -ge 20 -a "$rows" -lt 1000 ]
  [ "$signal" = TERM ] && check "interrupted: exit status 4, got $status" [ "$status" = 4 ]
  [ "$signal" = TERM ] && check "interrupted: says how to go on" grep -q 'interrupted after .* of 1000 runs; the same command' "$work/err"
  run sweep -o "$work/$signal" "$work/long.nml"
  check "$signal: taken up" grep -q 'of them there already' "$work/out"
  check "$signal: the same runs" cmp -s "$work/whole/long.runs.csv" "$work/$signal/long.runs.csv"
  check "$signal: the same revolutions" cmp -s "$work/whole/long.cycles.csv" "$work/$signal/long.cycles.csv"
done

# a table; runs that fail keep their reason and harm no other
printf '\357\273\277joint.clearance,lubrication.law,lubrication.kinematic_viscosity,"integrator.max_evaluations"\r\n2e-5,pinkus_sternlicht,0,100000\r\n-1e-5,pinkus_sternlicht,0,100000\r\n2e-5,oscillating_film,1.38e-5,"100000"\r\n2e-5,oscillating_film,0,100000\r\n2e-5,pinkus_sternlicht,0,500\r\n' >"$work/table.csv"
study table <<'END'
&study case = 'base.nml', table = 'table.csv', traces = 'failed' /
END
run sweep -o "$work/t" "$work/table.nml"
check "failed runs: exit status 4, got $status" [ "$status" = 4 ]
check "failed runs are counted" grep -q 'table.nml: 3 of 5 runs failed' "$work/err"
row() { sed -n "$(($1 + 1))p" "$work/t/table.runs.csv"; }
check "run 1 is done: $(row 1)" [ "$(row 1 | cut -d, -f 6)" = done ]
check "run 2 says why: $(row 2)" [ "$(row 2 | cut -d, -f 6)" = '&joint clearance = -1e-5: must be > 0 (m)' ]
check "run 3 is done: $(row 3)" [ "$(row 3 | cut -d, -f 6)" = done ]
check "run 4 says why: $(row 4)" [ "$(row 4 | cut -d, -f 6 | cut -c 1-35)" = '&lubrication kinematic_viscosity = ' ]
check "run 5 says why: $(row 5)" [ "$(row 5 | grep -c 'max_evaluations) at t = ')" = 1 ]
check "the run that failed on its way has a trace" [ -s "$work/t/table/5.csv" -a "$(ls "$work/t/table" | wc -l)" = 2 ]
run sweep -o "$work/t" "$work/table.nml"
check "failed runs are not repeated, and still are failures" [ "$status" = 4 ]

# messages
study bad <<'END'
&study case = 'base.nml' /
&parameter key = 'joint.clearence', from = 1e-5, to = 2e-5, count = 2 /
END
refused "misspelt key" 3 "bad.nml: &joint clearence: unknown key; did you mean clearance" "$work/bad.nml"
study bad <<'END'
&study case = 'base.nml' /
&parameter key = 'joint.clearance', frm = 1e-5, to = 2e-5, count = 2 /
END
refused "misspelt key of the study" 3 "bad.nml:2: &parameter frm: unknown key; did you mean from" "$work/bad.nml"
study bad <<'END'
&study case = 'base.nml' /
&parameter key = 'joint.clearance', from = 1e-5, to = 2e-5 /
END
refused "no count" 3 "&parameter count.*required on a grid" "$work/bad.nml"
study bad <<'END'
&study case = 'base.nml', table = 'bad.csv' /
END
refused "no table" 3 "bad.csv: No such file" "$work/bad.nml"
printf 'joint.clearance,initial.crank_speed\n1e-5,100\n2e-5,fast\n' >"$work/bad.csv"
refused "text for a number" 3 "bad.csv:3: column 2, initial.crank_speed = fast: must be a number" "$work/bad.nml"
printf 'joint.clearance,initial.crank_speed\n1e-5\n' >"$work/bad.csv"
refused "a short row" 3 "bad.csv:2: .*the header has 2 fields, this row fewer" "$work/bad.nml"
study bad <<'END'
&study case = 'none.nml' /
&parameter key = 'joint.clearance', values = 1e-5 /
END
refused "no base case" 3 "none.nml: No such file" "$work/bad.nml"
refused "no study" 2 "no study file"
refused "a case for a study" 3 "sim_I.nml:[0-9]*: &case: .*run it with gudgeon cases/sim_I.nml, without sweep" cases/sim_I.nml
study ends <<'END'
&study case = 'base.nml' /
&parameter key = 'integrator.end_time', values = 0.035, 0.065 /
END
run -q sweep -o "$work/ends" -s integrator.revolutions=1 "$work/ends.nml"
check "a parameter that ends the run takes the revolutions of the case away, status $status" [ "$status" = 0 ]
check "and so the runs end" [ "$(awk -F, 'NR > 1 { printf "%s ", $4 }' "$work/ends/ends.runs.csv")" = "1 2 " ]
run sweep -q -o "$work/dry" -s lubrication=none -s integrator.revolutions=2 -s contact.restitution=0.5 "$work/grid.nml"
check "a sweep without its film has impacts" [ "$(awk -F, 'NR > 1 && $8 > 0' "$work/dry/grid.runs.csv" | wc -l)" -gt 6 ]
run --fresh cases/sim_I.nml
check "--fresh is for studies" [ "$status" = 2 ]
refused "rows beyond the study" 3 "the study has 12 runs" --rows 5:20 "$work/grid.nml"
refused "rows backwards" 2 "A:B" --rows 5:4 "$work/grid.nml"
run sweep --check "$work/grid.nml"
check "--check counts the runs" [ "$status" = 0 -a "$(cat "$work/out")" = "$work/grid.nml: correct, 12 runs" ]
run sweep --check "$work/table.nml"
check "--check does not call it correct" [ "$status" = 3 -a ! -s "$work/out" ]
check "--check finds the run that cannot be" grep -q 'table.nml: run 2: .*clearance = -1e-5: must be > 0' "$work/err"
run sweep --template
cp "$work/out" "$work/template.nml"
cp "$work/base.nml" "$work/sim_I.nml"
check "the template names every key" [ "$(grep -c '!' "$work/template.nml")" -gt 18 ]

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]

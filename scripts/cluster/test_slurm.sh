#!/bin/bash
# Runs a small study with the SLURM executor of the Snakefile and compares the result with that of one process, byte for byte. The
# cluster has one node, on this machine; the script starts it and stops it at the end.
#
#   scripts/cluster/test_slurm.sh [--keep]     from anywhere, as root; --keep: do not delete the files and the logs of the daemons
#
# Needs Debian's packages slurmctld, slurmd, slurm-client and munge, and installs those that are missing. All files are
# in one temporary directory; separate ports and a separate key avoid conflicts with a SLURM that is installed on this machine. Ends
# with the line "N passed, N failed".
cd "$(dirname "$0")/../.." || exit 1
[ "$(id -u)" = 0 ] || { echo "test_slurm: must be root, to start the daemons of SLURM" >&2; exit 1; }
scripts/setup.sh --studies || exit 1
if ! command -v slurmctld slurmd munged sbatch >/dev/null; then
  apt-get update -qq >&2 &&
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends slurmctld slurmd slurm-client munge \
      >&2 ||
    exit 1
fi

work=$(mktemp -d)
daemons=()
finish() {
  for ((i = ${#daemons[@]} - 1; i >= 0; i--)); do
    kill "${daemons[i]}" 2>/dev/null && wait "${daemons[i]}" 2>/dev/null
  done
  [ "$keep" = --keep ] && echo "test_slurm: files in $work" || rm -rf "$work"
}
keep=$1
trap finish EXIT

node=$(hostname -s)
mkdir "$work/state" "$work/spool"
(umask 077 && head -c 1024 /dev/urandom >"$work/munge.key")
cat >"$work/slurm.conf" <<END
ClusterName=gudgeon
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
# no cgroups, no accounting: neither systemd nor a data base is needed
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
# time for which squeue lists jobs that have ended [s]
MinJobAge=600
NodeName=$node NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=1000
PartitionName=all Nodes=$node Default=YES
END
export SLURM_CONF=$work/slurm.conf
# the job steps of Snakemake remove SLURM_CONF from the environment of srun; this script sets it again
mkdir "$work/bin"
printf '#!/bin/sh\nSLURM_CONF=%s exec %s "$@"\n' "$SLURM_CONF" "$(command -v srun)" >"$work/bin/srun"
chmod +x "$work/bin/srun"

munged --foreground --force --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munge.pid" \
  --log-file="$work/munge.log" --seed-file="$work/munge.seed" >"$work/munged.out" 2>&1 &
daemons+=($!)
slurmctld -D -f "$SLURM_CONF" >"$work/slurmctld.out" 2>&1 &
daemons+=($!)
slurmd -D -N "$node" -f "$SLURM_CONF" >"$work/slurmd.out" 2>&1 &
daemons+=($!)
for _ in $(seq 30); do
  sinfo --noheader --states=idle 2>/dev/null | grep -q "$node" && break
  sleep 1
done
sinfo || { tail -n 5 "$work"/*.out >&2; echo "0 passed, 1 failed"; exit 1; }

cat >"$work/small.nml" <<END
&study
  title = 'A small study', case = '$PWD/cases/sim_I.nml', settle_cycles = 1, cycles = .true.
  strobe_angle_deg = 90.0, strobe_columns = 'eccentricity_x,film_thickness'
/
&parameter key = 'joint.clearance', from = 10.0e-6, to = 40.0e-6, count = 5 /
&parameter key = 'initial.crank_speed', from = 100.0, to = 400.0, count = 4 /
END

passed=0
failed=0
check() {   # check NAME COMMAND...
  local name=$1
  shift
  if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $name"; fi
}

options="--set integrator.method=auto"
PATH=$work/bin:$PWD/.venv/bin:$PATH
snakemake -s scripts/cluster/Snakefile --directory "$work" --executor slurm --jobs 4 --slurm-no-account \
  --slurm-logdir "$work/slurm_logs" --slurm-keep-successful-logs --slurm-status-command squeue \
  --slurm-init-seconds-before-status-checks 2 --default-resources runtime=5 mem_mb=200 --config study="$work/small.nml" \
  chunk=6 out="$work/cluster" options="$options" ${GUDGEON:+program="$GUDGEON"} >"$work/snakemake.out" 2>&1
check "snakemake, SLURM executor" [ $? = 0 ]
[ "$failed" = 0 ] || tail -n 40 "$work/snakemake.out"
jobs=$(grep -c 'has been submitted with SLURM jobid' "$work/snakemake.out")
check "four parts were submitted to SLURM ($jobs)" [ "$jobs" = 4 ]
check "SLURM lists four completed jobs" [ "$(squeue --states=COMPLETED --noheader | wc -l)" = 4 ]

# shellcheck disable=SC2086  # options are words
"$work/cluster/small.jobs/gudgeon" sweep -q -o "$work/one" $options "$work/small.nml"
check "one process" [ $? = 0 ]
for kind in runs cycles strobe; do
  check "$kind: the joined file is that of one process" cmp "$work/one/small.$kind.csv" "$work/cluster/small.$kind.csv"
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]

#!/usr/bin/env bash
# A private Slurm on this machine, for tests: two nodes of 1 CPU, without systemd, cgroups, accounting or root.
# Usage: slurm.sh up FOLDER [LINE...]   all of its state lives in FOLDER; each LINE, as MaxArraySize=20, goes to slurm.conf;
#        slurm.sh down FOLDER           the variables NODES, CPUS and MEMORY (MB) change the number and size of nodes
# `up` prints the line to say to a shell, export SLURM_CONF=FOLDER/slurm.conf, which is all that sbatch and squeue need.
# Needs Debian's slurm-wlm, which brings munge. Nothing outside of FOLDER changes; the machine's name need
# not resolve.
set -u

die() { printf 'slurm.sh: %s\n' "$1" >&2; exit 1; }
[[ $# -ge 2 && ($1 == up || $1 == down) ]] || die "usage: slurm.sh up FOLDER [LINE...] | slurm.sh down FOLDER"
command=$1
nodes=${NODES:-2} cpus=${CPUS:-1} memory=${MEMORY:-4000}
folder=$(realpath -m -- "$2")
shift 2
lines=("$@")
[ ${#folder} -le 80 ] || die "$folder: the name is too long for the sockets in it"  # sun_path holds 108 bytes
export SLURM_CONF=$folder/slurm.conf
PATH=$PATH:/usr/sbin:/sbin

# free_port: below the ports that the kernel hands out, where nothing listens now. Another may take it before we do:
# `up` tries again then.
free_port() {
  local port
  while port=$((10000 + (RANDOM * 32768 + RANDOM) % 20000)); do
    (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null || { echo "$port"; return; }
  done
}

# bind_to_loopback HOST: where the machine's name means that. Otherwise daemons listen on all addresses, and munge guards.
bind_to_loopback() {
  [[ $(getent ahostsv4 "$1") != 127.* ]] || echo CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
}

write_conf() {
  local i user host
  user=$(id -un) host=$(uname -n) host=${host%%.*}
  cat <<CONF
ClusterName=nullcone
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
# A requeued job waits for a second more than cred_expire; 120 otherwise.
AuthInfo=socket=$folder/run/munge.sock,cred_expire=5
CredType=cred/munge
$(bind_to_loopback "$host")
SlurmctldPort=$(free_port)
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool/%n
SlurmctldPidFile=$folder/run/slurmctld.pid
SlurmdPidFile=$folder/run/slurmd.%n.pid
SlurmctldLogFile=$folder/log/slurmctld.log
SlurmdLogFile=$folder/log/slurmd.%n.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc=$folder/log/jobcomp.txt
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
DefMemPerNode=100
# Tests wait for decisions; the scheduler looks once a second at best.
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0,bf_interval=1
KillWait=2
# What has ended stays in the answers of squeue and scontrol.
MinJobAge=3600
ReturnToService=2
SlurmdTimeout=30
CONF
  for ((i = 1; i <= nodes; ++i)); do
    echo "NodeName=n$i NodeHostname=$host NodeAddr=127.0.0.1 Port=$(free_port) CPUs=$cpus RealMemory=$memory"
  done
  [ ${#lines[@]} -eq 0 ] || printf '%s\n' "${lines[@]}"
  echo "PartitionName=main Nodes=n[1-$nodes] Default=YES MaxTime=INFINITE State=UP"
}

# Processes of this Slurm: daemons carry a mark in their environment, and jobs what Slurm puts there; slurmstepd writes its
# title over it, and is told by the folder it stands in.
processes() {
  local process
  for process in /proc/[0-9]*; do
    if [ "$process/cwd" -ef "$folder/log" ] && [[ $(cat "$process/comm") == slurm* ]] ||
      tr '\0' '\n' <"$process/environ" | awk -v mark="NULLCONE_SLURM=$folder" -v conf="SLURM_CONF=$SLURM_CONF" '
        $0 == mark { daemon = 1 } $0 == conf { ours = 1 } /^SLURM_JOB_ID=/ { job = 1 }
        END { exit !(daemon || (ours && job)) }'
    then echo "${process#/proc/}"; fi
  done 2>/dev/null
}

down() {
  local i pids
  for ((i = 0; i < 50; ++i)); do  # a daemon may be starting a task at this moment
    mapfile -t pids < <(processes)
    [ ${#pids[@]} -gt 0 ] || return 0
    kill -KILL "${pids[@]}" 2>/dev/null
    sleep 0.1
  done
  die "cannot end the processes ${pids[*]}"
}

start() {
  local i NULLCONE_SLURM=$folder
  export NULLCONE_SLURM
  write_conf >"$SLURM_CONF"
  munged --force --key-file="$folder/munge.key" --socket="$folder/run/munge.sock" --pid-file="$folder/run/munged.pid" \
    --log-file="$folder/log/munged.log" --seed-file="$folder/munge.seed" || return
  slurmctld -c || return
  for ((i = 1; i <= nodes; ++i)); do slurmd -N "n$i" || return; done
  for ((i = 0; i < 100; ++i)); do
    [ "$(sinfo -h -N -t idle -o %N 2>/dev/null | wc -l)" -eq "$nodes" ] && return 0
    sleep 0.1
  done
  return 1
}

up() {
  local i tool _
  for tool in munged slurmctld slurmd sinfo; do
    command -v $tool >/dev/null || die "$tool is not there; install the packages slurm-wlm and munge"
  done
  [ -z "$(processes)" ] || die "$folder: a Slurm runs there already"
  mkdir -p "$folder"/{state,spool,log,run} || exit 1
  for ((i = 1; i <= nodes; ++i)); do mkdir -p "$folder/spool/n$i"; done
  chmod 755 "$folder" "$folder/run"
  [ -f "$folder/munge.key" ] || (umask 077; head -c 1024 /dev/urandom >"$folder/munge.key")
  echo 'CgroupPlugin=cgroup/v1' >"$folder/cgroup.conf"  # its search for one would fail in containers
  for _ in 1 2 3; do  # somebody may have taken a port
    start 2>"$folder/log/start.log" >&2 && { echo "export SLURM_CONF=$SLURM_CONF"; return; }
    down
  done
  die "does not come up: $(tail -n 1 "$folder/log/start.log") (logs are in $folder/log)"
}

"$command"

!> Shares numbered tasks among processes: copies of this program that take one task after the other, each the next that nobody has
!> taken. What a task has to report is sent to this process as a note.
module process_pool
  use posix_files, only: read_bytes, write_all, close_file, wait_for_input, interrupted, error_interrupted
  use posix_processes, only: fork_worker, wait_for_worker, ask_to_end, leave_worker, open_pipe, available_processors
  implicit none
  private
  public :: tasks_t, note_t, share, available_processors

  !> A note about a task. It is shorter than what a pipe keeps together.
  type :: note_t
    integer :: task = 0
    integer :: worker = 0
    logical :: has_begun = .false.      !! the task has only begun
    integer :: numbers(2) = 0
    character(len=1000) :: text = ''
  end type note_t

  type, abstract :: tasks_t
    logical :: is_over = .false.        !! set by `record_note`: nothing more is to be done
  contains
    procedure(carry_out), deferred :: carry_out
    procedure(record_note), deferred :: record_note
    procedure(lost), deferred :: lost
  end type tasks_t

  abstract interface
    !> Carry out a task, in a copy of this program or here. `note` is for `record_note`. An interruption must end it soon.
    subroutine carry_out(self, task, note)
      import :: tasks_t, note_t
      class(tasks_t), intent(inout) :: self
      integer, intent(in) :: task
      type(note_t), intent(inout) :: note
    end subroutine carry_out

    !> A task has ended with this note.
    subroutine record_note(self, note)
      import :: tasks_t, note_t
      class(tasks_t), intent(inout) :: self
      type(note_t), intent(in) :: note
    end subroutine record_note

    !> A process was killed by this signal (0: it ended by itself) while it carried out this task.
    subroutine lost(self, task, signal)
      import :: tasks_t
      class(tasks_t), intent(inout) :: self
      integer, intent(in) :: task, signal
    end subroutine lost
  end interface

contains

  !> Carry out the tasks 1 to n in up to `jobs` processes; one alone is this one.
  subroutine share(tasks, n, jobs)
    class(tasks_t), intent(inout) :: tasks
    integer, intent(in) :: n, jobs
    integer :: queue(2), notes(2), process(min(jobs, n)), i
    logical :: is_open
    type(note_t) :: note
    process = -1
    is_open = size(process) > 1
    if (is_open) call open_pipe(queue, is_open)
    if (is_open) call open_pipe(notes, is_open)
    if (is_open) then
      do i = 1, size(process)
        call fork_worker(process(i))
        if (process(i) == 0) call work(tasks, i, queue, notes)
      end do
    end if
    if (any(process > 0)) then
      call close_end(queue(1))
      call close_end(notes(2))
      call supervise(tasks, n, process, queue(2), notes(1))
      return
    end if
    do i = 1, n
      note = note_t(task=i)
      call tasks%carry_out(i, note)
      call tasks%record_note(note)
    end do
  end subroutine share

  !> The work of a copy of this program: tasks from the queue until there are none.
  subroutine work(tasks, worker, queue, notes)
    class(tasks_t), intent(inout) :: tasks
    integer, intent(in) :: worker, queue(2), notes(2)
    character(len=4) :: number
    type(note_t) :: note
    integer :: done, status
    call close_end(queue(2))
    call close_end(notes(1))
    do
      call read_bytes(queue(1), number, done, status)
      if (status == error_interrupted) cycle
      if (done < len(number)) exit
      note = note_t(task=transfer(number, 1), worker=worker, has_begun=.true.)
      call send(note)
      note%has_begun = .false.
      call tasks%carry_out(note%task, note)
      call send(note)
    end do
    call leave_worker()

  contains

    subroutine send(note)
      type(note_t), intent(in) :: note
      character(len=storage_size(note)/8) :: bytes
      integer :: done, unused
      bytes = transfer(note, bytes)
      call write_all(notes(2), bytes, done, unused)
    end subroutine send
  end subroutine work

  !> Give out the tasks and collect the notes, until all processes have ended. If the user interrupts, or nothing more is to be
  !> done, they are asked to end.
  subroutine supervise(tasks, n, process, queue, notes)
    class(tasks_t), intent(inout) :: tasks
    integer, intent(in) :: n, process(:), queue, notes
    integer, parameter :: timeout = 200   !! [ms]
    integer, parameter :: room = 500       !! number of tasks that the queue can hold
    character(len=storage_size(note_t())/8) :: bytes
    type(note_t) :: note
    integer :: present_task(size(process)), given, ended, done, status, i
    logical :: has_input, is_over, was_asked
    present_task = 0
    was_asked = .false.
    given = 0
    ended = 0
    do
      do while (given < min(n, ended + room))
        given = given + 1
        call write_all(queue, transfer(given, '    '), done, status)
        if (given == n) call close_end(queue)
      end do
      call wait_for_input(notes, timeout, has_input)
      is_over = interrupted()
      if ((is_over .or. tasks%is_over) .and. .not. was_asked) then
        was_asked = .true.
        do i = 1, size(process)
          if (process(i) > 0) call ask_to_end(process(i))
        end do
      end if
      if (.not. has_input) cycle
      call read_bytes(notes, bytes, done, status)
      if (status == error_interrupted) cycle
      if (done < len(bytes)) exit
      note = transfer(bytes, note)
      present_task(note%worker) = merge(note%task, 0, note%has_begun)
      if (note%has_begun) cycle
      ended = ended + 1
      call tasks%record_note(note)
    end do
    call close_end(notes)
    do i = 1, size(process)
      if (process(i) <= 0) cycle
      status = wait_for_worker(process(i))
      if (present_task(i) > 0) call tasks%lost(present_task(i), status)
    end do
  end subroutine supervise

  subroutine close_end(descriptor)
    integer, intent(in) :: descriptor
    integer :: ignored
    call close_file(descriptor, ignored)
  end subroutine close_end
end module process_pool

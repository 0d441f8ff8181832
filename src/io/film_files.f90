!> Files of films: tables of film laws, and NAME.film.csv, the pressure of films over half of the bearing at the times that the case
!> asks for. Tables are stored between runs, in the user's cache folder or in a file that the case names, since they take long to
!> compute.
!>
!> The file of a table contains a line that identifies its format, the key of the table, the numbers of the table, and a checksum
!> of all this. A damaged file, or one written by another version of the program, is computed again; if it cannot be written into
!> the cache, the run continues without storing it. Programs that round differently have files of their own in the cache. A file
!> that a case names is replaced only if it is a table of a film, of any parameters.
module film_files
  use kinds, only: dp
  use constants, only: degree
  use error_handling, only: error_t, fail, status_integration
  use bearing_size, only: bearing_t
  use checksums, only: checksum_t, checksum_of, checksum_length
  use joint_places, only: places, n_places, in_order, spot_name
  use case_definition, only: case_t
  use joint_case, only: joint_case_t
  use film_snapshots, only: film_field_t, skirt_field_t
  use film_law, only: film_law_t, table_watch_t
  use film_solution, only: solved_film
  use finite_film, only: film_answer_t, cavitation_reynolds
  use posix_files, only: make_directory, interrupted, error_text, error_no_entry
  use growing_text, only: growing_text_t
  use number_text, only: real_text, short_text, quantity_text
  use run_progress, only: progress_t, clock, tell
  use result_file, only: write_text
  use text_tools, only: integer_text, path_beside, printable
  use text_file, only: read_whole
  implicit none
  private
  public :: provide_tables, tell_tables, film_table_fault, write_film_file, write_skirt_file, progress_watch_t

  character(len=*), parameter :: newline = achar(10), title = 'gudgeon film table'//newline

  real(dp), parameter :: trial = 0.3_dp   !! longest time that a check spends to find out how long a table takes [s]

  !> Stops the computation of a table after a while, to find out how long all of it takes.
  type, extends(table_watch_t) :: trial_watch_t
    real(dp) :: began = 0, took = 0   !! [s]
    real(dp) :: share = 0             !! of the rows done
  contains
    procedure :: row_done => time_row
  end type trial_watch_t

  !> Shows the progress of a table, and ends its computation if the user interrupts.
  type, extends(table_watch_t) :: progress_watch_t
    type(progress_t) :: progress
  contains
    procedure :: row_done
  end type progress_watch_t

contains

  !> Give the films of a case their tables, stored or new ones. `announces`: the user is told, in one line, that a table is
  !> computed. Errors: the user interrupted (status_integration); the file that the case names cannot be written (status_output).
  subroutine provide_tables(case, announces, shows_progress, error, watch)
    type(case_t), intent(inout) :: case
    logical, intent(in) :: announces, shows_progress
    type(error_t), allocatable, intent(out) :: error
    class(progress_watch_t), intent(in), optional :: watch   !! is told when a computation begins and ends
    class(progress_watch_t), allocatable :: own
    integer :: i
    if (present(watch)) then
      allocate (own, source=watch)
    else
      allocate (own)
    end if
    do i = 1, n_places
      if (.not. allocated(error)) call provide_table(case%joints(in_order(i)), case, announces, shows_progress, own, error)
    end do
  end subroutine provide_tables

  subroutine provide_table(joint, case, announces, shows_progress, watch, error)
    type(joint_case_t), intent(inout) :: joint
    type(case_t), intent(in) :: case
    logical, intent(in) :: announces, shows_progress
    class(progress_watch_t), intent(inout) :: watch
    type(error_t), allocatable, intent(out) :: error
    type(bearing_t) :: bearing
    character(len=:), allocatable :: key, path
    logical :: is_restored, is_named
    real(dp) :: began   ! [s]
    if (.not. (allocated(joint%film) .and. joint%has_bearing())) return
    bearing = joint%bearing(case%mechanism%rod_length)
    associate (tolerance => case%integrator%relative_tolerance)
      key = joint%film%table_key(bearing, tolerance)
      if (key == joint%film%table_of) return
      began = clock()
      call find_file(joint%film, case, key, .true., path, is_named)
      call load(path, key, joint%film, is_restored)
      if (.not. is_restored) then
        if (announces) call tell(printable(case%file, 200)//': computing the film table of a bearing with L/D = '// &
                                 short_text(0.5_dp*bearing%length/bearing%pin_radius())//place_of(path))
        call watch%progress%start(case%name//': film table', shows_progress)
        call joint%film%make_table(bearing, tolerance, watch)
        call watch%progress%finish()
        if (watch%wants_to_stop) then
          call fail(error, 'interrupted before it began, while its film table was computed', status_integration)
        else
          call save(path, key, joint%film, error)
          if (allocated(error) .and. .not. is_named) deallocate (error)
        end if
      end if
      joint%film%table_time = clock() - began
    end associate
  end subroutine provide_table

  !> Whether the tables of films are there or how long it takes to compute them, for the user; empty if the films need none.
  subroutine tell_tables(case, text)
    type(case_t), intent(in) :: case
    character(len=:), allocatable, intent(out) :: text
    character(len=:), allocatable :: more
    integer :: i
    text = ''
    do i = 1, n_places
      call tell_table(case%joints(in_order(i)), case, more)
      if (more == '') cycle
      if (text /= '') text = text//'; '
      text = text//trim(places(in_order(i))%title)//': '//more
    end do
  end subroutine tell_tables

  !> The same for one joint.
  subroutine tell_table(joint, case, text)
    type(joint_case_t), intent(in) :: joint
    type(case_t), intent(in) :: case
    character(len=:), allocatable, intent(out) :: text
    class(film_law_t), allocatable :: film
    type(trial_watch_t) :: watch
    type(bearing_t) :: bearing
    character(len=:), allocatable :: key, path
    logical :: is_restored, is_named
    text = ''
    if (.not. (allocated(joint%film) .and. joint%has_bearing())) return
    allocate (film, source=joint%film)
    bearing = joint%bearing(case%mechanism%rod_length)
    key = film%table_key(bearing, case%integrator%relative_tolerance)
    if (key == '') return
    call find_file(film, case, key, .false., path, is_named)
    call load(path, key, film, is_restored)
    text = 'stored in '//printable(path, 200)
    if (is_restored) return
    watch%began = clock()
    call film%make_table(bearing, case%integrator%relative_tolerance, watch)
    text = 'must be computed, in about '//quantity_text(watch%took/watch%share, 's', 1)
  end subroutine tell_table

  !> The file that keeps a table; an empty path if there is none.
  subroutine find_file(film, case, key, makes_folder, path, is_named)
    class(film_law_t), intent(in) :: film
    type(case_t), intent(in) :: case
    character(len=*), intent(in) :: key
    logical, intent(in) :: makes_folder   !! the cache folder is made if it is not there
    character(len=:), allocatable, intent(out) :: path
    logical, intent(out) :: is_named   !! the case names it
    is_named = .false.
    if (allocated(film%table_file)) is_named = film%table_file /= ''
    if (is_named) then
      path = path_beside(case%file, film%table_file)
    else
      path = path_for(case, key, makes_folder)
    end if
  end subroutine find_file

  subroutine time_row(self, done, rows)
    class(trial_watch_t), intent(inout) :: self
    integer, intent(in) :: done, rows
    self%took = clock() - self%began
    self%share = real(done, dp)/rows
    self%wants_to_stop = self%took > trial
  end subroutine time_row

  subroutine row_done(self, done, rows)
    class(progress_watch_t), intent(inout) :: self
    integer, intent(in) :: done, rows
    call self%progress%update(real(done, dp)/rows)
    self%wants_to_stop = interrupted()
  end subroutine row_done

  !> Where a table is kept, for the user.
  function place_of(path) result(text)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: text
    text = ', kept in '//printable(path, 200)
    if (path == '') text = '; there is no folder to keep it in'
  end function place_of

  !> Path of a stored table; empty if there is no cache folder.
  function path_for(case, key, makes_folder) result(path)
    type(case_t), intent(in) :: case
    character(len=*), intent(in) :: key
    logical, intent(in) :: makes_folder
    character(len=:), allocatable :: path
    type(checksum_t) :: sum
    integer :: status
    if (allocated(case%cache)) then
      path = case%cache
      if (path == '') return
    else
      call get_variable('XDG_CACHE_HOME', path)
      if (index(path, '/') /= 1) then   ! relative paths are to be ignored
        call get_variable('HOME', path)
        if (path == '') return
        path = path//'/.cache'
      end if
      path = path//'/gudgeon'
    end if
    status = 0
    if (makes_folder) call make_directory(path, status)
    call sum%add(key//arithmetic())
    path = path//'/film-'//sum%hexadecimal()//'.table'
    if (status /= 0) path = ''
  end function path_for

  !> Bytes that tell how this program rounds on this processor, results of a film: a table in the cache is of a program that rounds
  !> as this one does, so that no run depends on which program ran before it.
  function arithmetic() result(text)
    character(len=32) :: text
    type(film_answer_t) :: film
    call solved_film(32, 0.7_dp, cavitation_reynolds, 0.1_dp, 2.0_dp, film)
    text = transfer([film%force, film%flow, film%most], text)
  end function arithmetic

  !> Value of an environment variable; empty if it is not set.
  subroutine get_variable(name, value)
    character(len=*), intent(in) :: name
    character(len=:), allocatable, intent(out) :: value
    integer :: length
    call get_environment_variable(name, length=length)
    allocate (character(len=length) :: value)
    if (length > 0) call get_environment_variable(name, value)
  end subroutine get_variable

  !> Why a file that a case names cannot keep a table: it is there, but is not a table of a film. Empty if it can.
  function film_table_fault(path) result(fault)
    character(len=*), intent(in) :: path
    character(len=:), allocatable :: fault, bytes
    integer :: status
    call read_whole(path, bytes, status)
    fault = ''
    if (status /= 0 .and. status /= error_no_entry) fault = error_text(status)
    if (index(bytes, title) /= 1 .and. bytes /= '') fault = 'is not a film table of this program: name another file'
  end function film_table_fault

  !> Read a table from its file, if there is a complete one.
  subroutine load(path, key, film, is_restored)
    character(len=*), intent(in) :: path, key
    class(film_law_t), intent(inout) :: film
    logical, intent(out) :: is_restored
    character(len=:), allocatable :: bytes, head
    real(dp) :: numbers(0)
    integer :: status, last

    is_restored = .false.
    if (path == '') return
    call read_whole(path, bytes, status)
    head = title//key//newline
    last = len(bytes) - checksum_length
    if (status /= 0 .or. last < len(head)) return
    if (bytes(:len(head)) /= head) return
    if (bytes(last + 1:) /= checksum_of(bytes(:last))) return
    film%table_of = ''
    call film%restore_table(transfer(bytes(len(head) + 1:last), numbers), is_restored)
    if (is_restored) film%table_of = key
  end subroutine load

  !> Store a table if possible. It is written under a temporary name first.
  subroutine save(path, key, film, error)
    character(len=*), intent(in) :: path, key
    class(film_law_t), intent(inout) :: film
    type(error_t), allocatable, intent(out) :: error
    real(dp), allocatable :: numbers(:)
    character(len=:), allocatable :: bytes
    if (path == '') return
    numbers = film%table_numbers()
    allocate (character(len=8*size(numbers)) :: bytes)
    bytes = title//key//newline//transfer(numbers, bytes)
    call write_text(path, bytes//checksum_of(bytes), error)
  end subroutine save

  !> Write one row for each node of the film: the angle from x towards y in the frame of the bearing, and the axial distance from
  !> its middle. The pressures in the other half are equal. Error: the file cannot be written (status_output).
  subroutine write_film_file(path, fields, error)
    character(len=*), intent(in) :: path
    type(film_field_t), intent(in) :: fields(:)
    type(error_t), allocatable, intent(out) :: error
    type(growing_text_t) :: file
    integer :: i, j, k
    call file%append('time[s],crank_angle[rad],joint,angle[rad],film_thickness[m],place[m],pressure[Pa]'//achar(10))
    do i = 1, size(fields)
      do j = 1, size(fields(i)%angle)
        do k = 1, size(fields(i)%along)
          associate (field => fields(i))
            call file%append(real_text(field%time)//','//real_text(field%crank_angle)//','//spot_name(field%place)//',')
            call file%append(real_text(field%angle(j) + field%direction)//',')
            call file%append(real_text(field%clearance - field%distance*cos(field%angle(j)))//',')
            call file%append(real_text(field%along(k))//','//real_text(field%pressure(j, k))//achar(10))
          end associate
        end do
      end do
    end do
    call write_text(path, file%text(:file%used), error)
  end subroutine write_film_file

  !> Write one row for each node of both faces of a skirt: the side of the cylinder's axis (1 towards +y), the height above the pin,
  !> the angle from the thrust axis; the pressures at the opposite angles are equal. Error: as above.
  subroutine write_skirt_file(path, fields, error)
    character(len=*), intent(in) :: path
    type(skirt_field_t), intent(in) :: fields(:)
    type(error_t), allocatable, intent(out) :: error
    type(growing_text_t) :: file
    integer :: i, j, k, side
    call file%append('time[s],crank_angle[rad],side,height[m],angle[deg],gap[m],pressure[Pa]'//achar(10))
    do i = 1, size(fields)
      associate (field => fields(i), faces => fields(i)%faces)
        do side = 1, 2
          do k = 1, size(faces%height)
            do j = 1, size(faces%angle)
              call file%append(real_text(field%time)//','//real_text(field%crank_angle)//','//integer_text(3 - 2*side)//',')
              call file%append(real_text(faces%height(k))//','//real_text(faces%angle(j)/degree)//',')
              call file%append(real_text(faces%gap(j, k, side))//','//real_text(faces%pressure(j, k, side))//achar(10))
            end do
          end do
        end do
      end associate
    end do
    call write_text(path, file%text(:file%used), error)
  end subroutine write_skirt_file
end module film_files

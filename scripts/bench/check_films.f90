!> Compares the film of finite length with the tables of an independent solver (data/film/phi_LD*.csv), bearing by bearing:
!> largest relative error of the force, of the side flow and of the largest pressure up to eps = 0.99, and of the force at 0.999.
!>
!>     check_films                  solve every row with 64, 128 and 192 nodes around the film: draft, standard, reference
!>     check_films POINTS NODES     use tables of POINTS values in each direction, solved with NODES nodes; with processor times
!>     check_films POINTS NODES 0.75 gumbel     the same for one bearing and one cavitation condition
program check_films
  use kinds, only: dp
  use constants, only: degree
  use finite_film, only: film_answer_t, cavitation_gumbel, cavitation_reynolds
  use film_map, only: film_map_t
  use film_solution, only: solved_film
  implicit none
  character(len=*), parameter :: bearings(5) = [character(len=4) :: '0.25', '0.5', '0.75', '1', '2']
  character(len=*), parameter :: conditions(2) = [character(len=8) :: 'gumbel', 'reynolds']
  integer, parameter :: levels(3) = [64, 128, 192]
  character(len=20) :: text, bearing, condition
  integer :: i, k, l, points, nodes

  points = 0
  bearing = ''
  condition = ''
  if (command_argument_count() == 4) then
    call get_command_argument(3, bearing)
    call get_command_argument(4, condition)
  end if
  if (command_argument_count() >= 2) then
    call get_command_argument(1, text)
    read (text, *) points
    call get_command_argument(2, text)
    read (text, *) nodes
  end if
  print '(a)', '| L/D | cavitation | table, nodes | force | side flow | largest pressure | force at eps = 0.999 '// &
    '| rows beyond 3e-4 and the error stated | processor [s] | table says of its error |'
  print '(a)', repeat('|---', 10)//'|'
  do i = 1, size(bearings)
    do k = 1, size(conditions)
      if (bearing /= '' .and. (bearings(i) /= bearing .or. conditions(k) /= condition)) cycle
      if (points > 0) then
        call compare(trim(bearings(i)), trim(conditions(k)), points, nodes)
      else
        do l = 1, size(levels)
          call compare(trim(bearings(i)), trim(conditions(k)), 0, levels(l))
        end do
      end if
    end do
  end do

contains

  subroutine compare(bearing, condition, points, nodes)
    character(len=*), intent(in) :: bearing, condition
    integer, intent(in) :: points, nodes
    type(film_map_t) :: map
    type(film_answer_t) :: got
    character(len=10) :: row_condition
    character(len=200) :: line
    real(dp) :: half_length, eps, alpha, force(2), flow, most, stated(2), off, worst(4)
    real(dp) :: started, finished
    integer :: unit, status, beyond, cavitation
    cavitation = merge(cavitation_gumbel, cavitation_reynolds, condition == 'gumbel')
    worst = 0
    beyond = 0
    call cpu_time(started)
    if (points > 0) call map%build(half_length_of(bearing), cavitation, points, nodes)
    call cpu_time(finished)
    open (newunit=unit, file='data/film/phi_LD'//bearing//'.csv', status='old', action='read')
    read (unit, '(a)') line
    do
      read (unit, '(a)', iostat=status) line
      if (status /= 0) exit
      read (line, *) half_length, row_condition, eps, alpha, force, flow, most, stated
      if (row_condition /= condition) cycle
      if (points > 0) then
        call map%force(eps**2, cos(alpha*degree), sin(alpha*degree), got%force(1), got%force(2))
        call map%peak_and_flow(eps**2, cos(alpha*degree), sin(alpha*degree), got%most, got%flow)
      else
        call solved_film(nodes, half_length, cavitation, 1 - eps, alpha*degree, got)
      end if
      off = norm2(got%force - force)/norm2(force)
      if (off > max(3e-4_dp, stated(1))) beyond = beyond + 1
      if (eps > 0.995_dp) then
        worst(4) = max(worst(4), off)
      else
        worst(:3) = max(worst(:3), [off, abs(got%flow/flow - 1), abs(got%most/most - 1)])
      end if
    end do
    close (unit)
    if (points == 0) call cpu_time(finished)
    print '(5a,i0,a,i0,4(a,es7.1),a,i0,a,f0.1,a,es7.1,a)', '| ', bearing, ' | ', condition, ' | ', points, ', ', nodes, ' | ', &
      worst(1), ' | ', &
      worst(2), ' | ', worst(3), ' | ', worst(4), ' | ', beyond, ' | ', finished - started, ' | ', map%largest_error, ' |'
  end subroutine compare

  pure real(dp) function half_length_of(bearing)
    character(len=*), intent(in) :: bearing
    read (bearing, *) half_length_of
  end function half_length_of
end program check_films

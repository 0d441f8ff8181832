!> Writes NAME.film.csv: the pressure of films over half of the bearing at the times that the case asks for.
module film_file
  use gudgeon_kinds, only: dp
  use gudgeon_errors, only: error_t
  use chain_motion, only: pin_names
  use film_snapshots, only: film_field_t
  use number_text, only: real_text
  use growing_text, only: growing_text_t
  use result_file, only: write_text
  implicit none
  private
  public :: write_film_file

contains

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
            call file%append(real_text(field%time)//','//real_text(field%crank_angle)//','//trim(pin_names(field%place))//',')
            call file%append(real_text(field%angle(j) + field%direction)//',')
            call file%append(real_text(field%clearance - field%distance*cos(field%angle(j)))//',')
            call file%append(real_text(field%along(k))//','//real_text(field%pressure(j, k))//achar(10))
          end associate
        end do
      end do
    end do
    call write_text(path, file%text(:file%used), error)
  end subroutine write_film_file
end module film_file
